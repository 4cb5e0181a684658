// SPDX-License-Identifier: Apache-2.0

#include "containers/exr.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>

#include <tex/mip_chain.h>

#include "base/guard.h"
#include "containers/exr_part.h"
#include "containers/exr_texture.h"

namespace tex {
namespace {

static_assert(std::endian::native == std::endian::little, "levels hold little-endian values, OpenEXR wants native ones");

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

const char* exr_version() { return OPENEXR_VERSION_STRING; }

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

}  // namespace tex
