// SPDX-License-Identifier: Apache-2.0

#include "containers/exr.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfTiledOutputFile.h>

#include <tex/mip_chain.h>

#include "base/guard.h"
#include "containers/exr_part.h"
#include "containers/exr_texture.h"

namespace tex {
namespace {

static_assert(std::endian::native == std::endian::little, "levels hold little-endian values, OpenEXR wants native ones");

constexpr int kTileSize = 64;

// -- reading -----------------------------------------------------------------------------------------------

// Opens the first part, checks it, and returns body(file, stream), a Result. Nothing that OpenEXR throws gets past here.
template <class Body>
auto with_exr(InputFile& file, const ReadOptions& options, const Body& body)
    -> decltype(body(std::declval<Imf::MultiPartInputFile&>(), std::declval<const ExrStream&>())) {
    return guarded([&]() -> decltype(body(std::declval<Imf::MultiPartInputFile&>(), std::declval<const ExrStream&>())) {
        if (const Result<void> settled = file.settle(largest_file(options)); !settled) return settled.error();
        ExrStream stream(file);
        try {
            check_attributes(stream);
            constexpr int kNoThreads = 0;
            constexpr bool kKeepTable = false;  // a table that has to be guessed is damage
            Imf::MultiPartInputFile exr(stream, kNoThreads, kKeepTable);
            const Result<Extent> extent = check_header(file.path(), exr.header(0), *file.size(), options);
            if (!extent) return extent.error();
            return body(exr, stream);
        } catch (const std::bad_alloc&) {
            throw;
        } catch (const std::exception& thrown) {
            if (stream.failure()) return *stream.failure();
            return exr_error(file.path(), thrown);
        }
    });
}

// Planes to interleaved texels. Values that came from half go back to the same half.
Level interleave(const Image& image, Format format) {
    Level level{image.extent(), std::vector<std::byte>(level_bytes(format, image.extent()))};
    std::byte* to = level.bytes.data();
    const bool half = format_info(format).bits == 16;
    for (int j = 0; j < level.extent.height; ++j) {
        for (int i = 0; i < level.extent.width; ++i) {
            for (const Plane<float>& plane : image.planes) {
                if (half) {
                    const std::uint16_t bits = Imath::half(plane.at(i, j)).bits();
                    std::memcpy(to, &bits, sizeof bits);
                    to += sizeof bits;
                } else {
                    std::memcpy(to, &plane.at(i, j), sizeof(float));
                    to += sizeof(float);
                }
            }
        }
    }
    return level;
}

}  // namespace

bool is_exr(std::span<const std::byte> head) {
    constexpr unsigned char kMagic[4] = {0x76, 0x2f, 0x31, 0x01};
    return head.size() >= sizeof kMagic && std::memcmp(head.data(), kMagic, sizeof kMagic) == 0;
}

Result<Image> read_exr(InputFile& file, const ReadOptions& options) {
    return with_exr(file, options, [](Imf::MultiPartInputFile& exr, const ExrStream& stream) -> Result<Image> {
        return PartReader(exr, stream, channels_of(exr.header(0))).read(0);
    });
}

Result<Texture> read_exr_texture(InputFile& file, const ReadOptions& options) {
    return with_exr(file, options, [&](Imf::MultiPartInputFile& exr, const ExrStream& stream) -> Result<Texture> {
        const Imath::Box2i window = exr.header(0).dataWindow();
        const Extent base{window.max.x - window.min.x + 1, window.max.y - window.min.y + 1};
        Result<ExrTexture> described = exr_texture_of(file.path(), exr.header(0), base);
        if (!described) return std::move(described).error();
        PartReader part(exr, stream, std::move(described->channels));
        Texture texture = std::move(described->head);
        for (int level = 0; level < described->levels; ++level) {
            texture.levels.push_back(interleave(part.read(level), texture.format));
        }
        return texture;
    });
}

// -- writing -----------------------------------------------------------------------------------------------

namespace {

class MemoryStream final : public Imf::OStream {
public:
    MemoryStream() : Imf::OStream("") {}
    void write(const char data[], int count) override {
        const auto n = static_cast<std::size_t>(count);
        if (bytes.size() < at_ + n) bytes.resize(at_ + n);
        std::memcpy(bytes.data() + at_, data, n);
        at_ += n;
    }
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t at) override { at_ = static_cast<std::size_t>(at); }

    std::vector<std::byte> bytes;

private:
    std::size_t at_ = 0;
};

// The interleaved texels of a level. OpenEXR's slices point to mutable bytes even where it only reads.
Imf::FrameBuffer frame_buffer(const Level& level, const FormatInfo& format, const std::vector<std::string>& names) {
    Imf::FrameBuffer buffer;
    const auto channel_bytes = static_cast<std::size_t>(format.bits / 8);
    char* base = const_cast<char*>(reinterpret_cast<const char*>(level.bytes.data()));
    for (std::size_t c = 0; c < names.size(); ++c) {
        buffer.insert(names[c].c_str(), Imf::Slice(format.bits == 16 ? Imf::HALF : Imf::FLOAT, base + c * channel_bytes,
                                                   format.block_bytes,
                                                   format.block_bytes * static_cast<std::size_t>(level.extent.width)));
    }
    return buffer;
}

void write_exr(Imf::OStream& stream, Imf::Header& header, const Texture& texture, const std::vector<std::string>& names) {
    const FormatInfo format = format_info(texture.format);
    constexpr int kNoThreads = 0;
    if (texture.levels.size() == 1) {
        Imf::OutputFile file(stream, header, kNoThreads);
        file.setFrameBuffer(frame_buffer(texture.levels.front(), format, names));
        file.writePixels(texture.extent().height);
        return;
    }
    header.setTileDescription(Imf::TileDescription(kTileSize, kTileSize, Imf::MIPMAP_LEVELS, Imf::ROUND_DOWN));
    Imf::TiledOutputFile file(stream, header, kNoThreads);
    for (int level = 0; level < file.numLevels(); ++level) {
        file.setFrameBuffer(frame_buffer(texture.levels[static_cast<std::size_t>(level)], format, names));
        file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
    }
}

}  // namespace

Result<std::vector<std::byte>> encode_exr(const Texture& texture) {
    return guarded([&]() -> Result<std::vector<std::byte>> {
        const FormatInfo format = format_info(texture.format);
        if (format.sample != SampleKind::floating || texture.levels.empty()) {
            return Error{ErrorCode::unsupported, {},
                         "EXR holds half and float, not " + std::string(name_of(kFormatNames, texture.format))};
        }
        const auto levels = static_cast<int>(texture.levels.size());
        if (levels > 1 && levels != level_count(texture.extent())) {
            return Error{ErrorCode::unsupported, {},
                         "EXR holds the base level or all " + std::to_string(level_count(texture.extent())) +
                             " mip levels, not " + std::to_string(levels)};
        }
        std::vector<std::string> names = {"R", "G", "B", "A"};
        names.resize(static_cast<std::size_t>(format.channels));
        if (format.channels == 1) names = {"Y"};

        Imf::Header header(texture.extent().width, texture.extent().height);
        header.compression() = Imf::ZIP_COMPRESSION;
        const Imf::PixelType type = format.bits == 16 ? Imf::HALF : Imf::FLOAT;
        for (const std::string& name : names) header.channels().insert(name, Imf::Channel(type));
        const bool holds_normals =
            std::find(texture.swizzle.begin(), texture.swizzle.end(), Component::x) != texture.swizzle.end();
        if (holds_normals) {
            header.insert(kNormalEncoding, Imf::StringAttribute("signed"));
            header.insert(kNormalYAxis, Imf::StringAttribute(std::string(name_of(kYAxisNames, texture.y_axis))));
        }
        MemoryStream stream;
        try {
            write_exr(stream, header, texture, names);
        } catch (const std::bad_alloc&) {
            throw;
        } catch (const std::exception& thrown) {
            return Error{ErrorCode::unsupported, {}, std::string("EXR cannot be written: ") + thrown.what()};
        }
        return std::move(stream.bytes);
    });
}

}  // namespace tex
