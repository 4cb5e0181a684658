// SPDX-License-Identifier: Apache-2.0

#include "containers/exr.h"

#include <algorithm>
#include <cstring>
#include <exception>
#include <optional>
#include <string>
#include <utility>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfTiledOutputFile.h>

#include <tex/mip_chain.h>

#include "base/guard.h"
#include "containers/exr_part.h"
#include "containers/row_target.h"

namespace tex {
namespace {

constexpr int kTileSize = 64;
constexpr int kNoThreads = 0;

// A file as OpenEXR writes it: everything once, from the beginning to the end, but for the table of offsets, which it goes back to. What is written before
// pixels() stays here until finish().
class TargetStream final : public Imf::OStream {
public:
    explicit TargetStream(WriteBytes write) : Imf::OStream(""), write_(std::move(write)) {}

    void write(const char data[], int count) override {
        const auto n = static_cast<std::size_t>(count);
        const auto at = static_cast<std::size_t>(at_);
        if (!pixels_) head_.resize(std::max(head_.size(), at + n));
        if (at + n <= head_.size()) {
            std::memcpy(head_.data() + at, data, n);
        } else if (!failure_) {
            const Result<void> written = write_(at_, std::as_bytes(std::span(data, n)));
            if (!written) failure_ = written.error();
        }
        at_ += n;
    }
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t at) override { at_ = at; }

    void pixels() { pixels_ = true; }
    Result<void> finish() {
        if (failure_) return *failure_;
        return write_(0, head_);
    }
    [[nodiscard]] const std::optional<Error>& failure() const { return failure_; }

private:
    const WriteBytes write_;
    std::vector<std::byte> head_;
    std::uint64_t at_ = 0;
    bool pixels_ = false;
    std::optional<Error> failure_;
};

std::vector<std::string> channels_for(const FormatInfo& format) {
    if (format.channels == 1) return {"Y"};
    std::vector<std::string> names = {"R", "G", "B", "A"};
    names.resize(static_cast<std::size_t>(format.channels));
    return names;
}

Imf::Header header_of(const TextureHead& texture) {
    const FormatInfo format = format_info(texture.format);
    Imf::Header header(texture.extent.width, texture.extent.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    const Imf::PixelType type = format.bits == 16 ? Imf::HALF : Imf::FLOAT;
    for (const std::string& name : channels_for(format)) header.channels().insert(name, Imf::Channel(type));
    const bool holds_normals =
        std::find(texture.swizzle.begin(), texture.swizzle.end(), Component::x) != texture.swizzle.end();
    if (holds_normals) {
        header.insert(kNormalEncoding, Imf::StringAttribute("signed"));
        header.insert(kNormalYAxis, Imf::StringAttribute(std::string(name_of(kYAxisNames, texture.y_axis))));
    }
    return header;
}

// Interleaved texels, `first` being the row that they begin with. OpenEXR's slices point to mutable bytes even where it only reads.
Imf::FrameBuffer frame_buffer(const std::byte* texels, Extent extent, int first, const FormatInfo& format) {
    Imf::FrameBuffer buffer;
    const auto channel_bytes = static_cast<std::size_t>(format.bits / 8);
    std::byte* channel = const_cast<std::byte*>(texels);
    for (const std::string& name : channels_for(format)) {
        buffer.insert(name.c_str(), Imf::Slice::Make(format.bits == 16 ? Imf::HALF : Imf::FLOAT, channel, Imath::V2i(0, first), extent.width,
                                                     extent.height, format.block_bytes,
                                                     format.block_bytes * static_cast<std::size_t>(extent.width)));
        channel += channel_bytes;
    }
    return buffer;
}

Error cannot_write(const std::exception& thrown) {
    return {ErrorCode::unsupported, {}, std::string("EXR cannot be written: ") + thrown.what()};
}

class ExrTarget final : public RowTarget {
public:
    ExrTarget(const TextureHead& head, WriteBytes write) : head_(head), format_(format_info(head.format)), stream_(std::move(write)) {}

    Result<void> begin() {
        return watched([&] {
            file_.emplace(stream_, header_of(head_), kNoThreads);
            stream_.pixels();
        });
    }
    Result<void> put(const std::byte* rows, int count) override {
        return watched([&] {
            file_->setFrameBuffer(frame_buffer(rows, {head_.extent.width, count}, file_->currentScanLine(), format_));
            file_->writePixels(count);
        });
    }
    Result<void> finish() override {
        file_.reset();  // writes the table, and keeps quiet about errors
        return stream_.finish();
    }

private:
    template <class Body>
    Result<void> watched(const Body& body) {
        try {
            body();
        } catch (const std::bad_alloc&) {
            throw;
        } catch (const std::exception& thrown) {
            return cannot_write(thrown);
        }
        if (stream_.failure()) return *stream_.failure();
        return {};
    }

    const TextureHead head_;
    const FormatInfo format_;
    TargetStream stream_;
    std::optional<Imf::OutputFile> file_;
};

void write_levels(TargetStream& stream, const Texture& texture) {
    const FormatInfo format = format_info(texture.format);
    Imf::Header header = header_of(head_of(texture));
    header.setTileDescription(Imf::TileDescription(kTileSize, kTileSize, Imf::MIPMAP_LEVELS, Imf::ROUND_DOWN));
    Imf::TiledOutputFile file(stream, header, kNoThreads);
    for (int level = 0; level < file.numLevels(); ++level) {
        const Level& texels = texture.levels[static_cast<std::size_t>(level)];
        file.setFrameBuffer(frame_buffer(texels.bytes.data(), texels.extent, 0, format));
        file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
    }
}

Result<std::vector<std::byte>> encode_levels(const Texture& texture) {
    std::vector<std::byte> bytes;
    TargetStream stream([&bytes](std::uint64_t, std::span<const std::byte> all) -> Result<void> {
        bytes.assign(all.begin(), all.end());
        return {};
    });
    try {
        write_levels(stream, texture);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& thrown) {
        return cannot_write(thrown);
    }
    if (const Result<void> done = stream.finish(); !done) return done.error();
    return bytes;
}

}  // namespace

Result<std::unique_ptr<RowTarget>> open_exr_target(const TextureHead& head, WriteBytes write) {
    return guarded([&]() -> Result<std::unique_ptr<RowTarget>> {
        if (format_info(head.format).sample != SampleKind::floating) {
            return Error{ErrorCode::unsupported, {},
                         "EXR holds half and float, not " + std::string(name_of(kFormatNames, head.format))};
        }
        auto target = std::make_unique<ExrTarget>(head, std::move(write));
        if (const Result<void> begun = target->begin(); !begun) return begun.error();
        return std::unique_ptr<RowTarget>(std::move(target));
    });
}

Result<std::vector<std::byte>> encode_exr(const Texture& texture) {
    return guarded([&]() -> Result<std::vector<std::byte>> {
        const auto levels = static_cast<int>(texture.levels.size());
        const bool is_floating = format_info(texture.format).sample == SampleKind::floating;
        if (levels <= 1 || !is_floating) return encode_rows(Container::exr, texture);
        if (levels != level_count(texture.extent())) {
            return Error{ErrorCode::unsupported, {},
                         "EXR holds the base level or all " + std::to_string(level_count(texture.extent())) +
                             " mip levels, not " + std::to_string(levels)};
        }
        return encode_levels(texture);
    });
}

}  // namespace tex
