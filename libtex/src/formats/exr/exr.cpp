// SPDX-License-Identifier: Apache-2.0

#include "formats/exr/exr.h"

#include <bit>
#include <cstring>
#include <utility>

#include <OpenEXRConfig.h>
#include <half.h>

#include <tex/mip_chain.h>

#include "formats/exr/exr_rows.h"
#include "threads/guard.h"

namespace tex {
namespace {

static_assert(std::endian::native == std::endian::little,
              "levels hold little-endian values, OpenEXR wants native ones");

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
    return guarded([&]() -> Result<Image> {
        const Result<std::unique_ptr<RowSource>> rows = open_exr_rows(file, options);
        if (!rows) return rows.error();
        return (*rows)->read_all();
    });
}

Result<Texture> read_exr_texture(InputFile& file, const ReadOptions& options) {
    return guarded([&]() -> Result<Texture> {
        Result<ExrTextureRows> rows = open_exr_texture_rows(file, options);
        if (!rows) return std::move(rows).error();
        Texture texture = std::move(rows->head);
        for (const std::unique_ptr<RowSource>& level : rows->levels) {
            const Result<Image> image = level->read_all();
            if (!image) return image.error();
            texture.levels.push_back(interleave(*image, texture.format));
        }
        return texture;
    });
}

}  // namespace tex
