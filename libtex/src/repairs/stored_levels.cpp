// SPDX-License-Identifier: Apache-2.0

#include "repairs/stored_levels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <utility>

#include <tex/format.h>

#include "rows/pack_rows.h"
#include "rows/unpack_rows.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

// The encoding of blocks with this format that has x and y where the swizzle has them. ATI2 is BC5 with y first.
std::optional<Encoding> block_encoding(Format format, const Swizzle& swizzle) {
    const auto place = [](const Swizzle& of, Component component) {
        return std::find(of.begin(), of.end(), component) - of.begin();
    };
    for (const Named<Encoding>& row : kEncodingNames) {
        const EncodingInfo made = encoding_info(row.value);
        if (made.format != format || !format_info(format).has_blocks()) continue;
        const bool has_z = place(swizzle, Component::z) < 4;
        const bool is_same = place(made.swizzle, Component::x) == place(swizzle, Component::x) &&
                             place(made.swizzle, Component::y) == place(swizzle, Component::y);
        if (!has_z && (is_same || (format == Format::bc5_unorm && swizzle == kSwizzleYx))) return row.value;
    }
    return std::nullopt;
}

// The normals of a level, for encoders of blocks, which read x and y alone.
NormalMap map_of(const StoredLevels& from, int level) {
    const Stored stored = from.stored(level);
    const Extent extent = stored.extent();
    NormalMap map(extent);
    const int x = stored.channel(Component::x), y = stored.channel(Component::y);
    const float sign = from.head.y_axis == YAxis::down ? -1.0f : 1.0f;
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const float a = stored.component(x, i, j), b = stored.component(y, i, j);
            map.x.at(i, j) = a;
            map.y.at(i, j) = sign * b;
            map.z.at(i, j) = std::sqrt(std::max(0.0f, 1.0f - a * a - b * b));
        }
    }
    return map;
}

template <class Code>
void store_snorm(const Image& image, int j, std::byte* out) {
    constexpr float kTop = sizeof(Code) == 1 ? 127.0f : 32767.0f;
    for (int i = 0; i < image.extent().width; ++i) {
        for (const Plane<float>& plane : image.planes) {
            const auto code = static_cast<Code>(std::round(std::clamp(plane.at(i, j), -1.0f, 1.0f) * kTop));
            std::memcpy(out, &code, sizeof code);
            out += sizeof code;
        }
    }
}

Result<Level> store_texels(const Image& image, Format format, const Execution& execution) {
    const FormatInfo info = format_info(format);
    const Extent extent = image.extent();
    Level level{extent, std::vector<std::byte>(level_bytes(format, extent))};
    const std::size_t pitch = level_bytes(format, {extent.width, 1});
    const auto store = [&](int begin, int end) {
        std::vector<std::byte> packed(pitch + kPackSlack * info.block_bytes);
        for (int j = begin; j < end; ++j) {
            std::byte* const out = level.bytes.data() + static_cast<std::size_t>(j) * pitch;
            if (info.sample == SampleKind::snorm) {
                info.bits == 8 ? store_snorm<std::int8_t>(image, j, out) : store_snorm<std::int16_t>(image, j, out);
                continue;
            }
            PackChannel channels[4];
            for (std::size_t c = 0; c < image.planes.size() && c < 4; ++c)
                channels[c] = {image.planes[c].row(j), false, true};
            pack_texels(info, channels, extent.width, packed.data());
            std::memcpy(out, packed.data(), pitch);
        }
    };
    if (auto done = parallel_for(execution, extent.height, rows_per_piece(extent), store); !done) return done.error();
    return level;
}

}  // namespace

StoredLevels StoredLevels::clone() const {
    StoredLevels copy{head, {}, is_signed, keeps_blocks};
    for (const Image& image : levels) {
        Image& to = copy.levels.emplace_back();
        to.names = image.names;
        to.sample = image.sample;
        to.bits = image.bits;
        to.normal_encoding = image.normal_encoding;
        for (const Plane<float>& plane : image.planes) to.planes.push_back(plane.clone());
    }
    return copy;
}

Result<StoredLevels> decode_levels(const Texture& texture, const Swizzle& swizzle, bool has_extras,
                                   const Execution& execution) {
    StoredLevels all;
    for (int k = 0; k < static_cast<int>(texture.levels.size()); ++k) {
        auto image = decode(texture, k, execution);
        if (!image) return image.error();
        all.levels.push_back(std::move(*image));
    }
    all.head.format = texture.format;
    all.head.swizzle = swizzle;
    all.head.swizzle_known = true;
    all.head.y_axis = texture.y_axis;
    all.head.y_known = texture.y_known;
    all.head.x_in_grey = texture.x_in_grey;
    all.head.normal_encoding = texture.normal_encoding;
    all.head.srgb = texture.srgb;
    all.is_signed = stores_signed(all.levels.front(), swizzle, range_of(texture.normal_encoding, UnpackOptions{}));
    all.keeps_blocks = !has_extras && block_encoding(texture.format, swizzle).has_value();
    return all;
}

Result<Texture> encode_levels(const StoredLevels& from, Effort effort, const Execution& execution) {
    Texture made = from.head;
    const FormatInfo info = format_info(from.head.format);
    if (info.has_blocks() && from.keeps_blocks) {
        MipChain chain;
        for (int k = 0; k < static_cast<int>(from.levels.size()); ++k) chain.levels.push_back(map_of(from, k));
        const Encoding encoding = *block_encoding(from.head.format, from.head.swizzle);
        auto packed = pack(chain, {encoding, from.head.y_axis, effort}, execution);
        if (!packed) return packed.error();
        made.levels = std::move(packed->levels);
        made.swizzle = encoding_info(encoding).swizzle;
        return made;
    }
    if (info.has_blocks()) {
        const auto channels = static_cast<int>(from.levels.front().planes.size());
        const bool is_float = from.is_signed || info.sample != SampleKind::unorm;
        made.format =
            *format_of(is_float ? SampleKind::floating : SampleKind::unorm, is_float ? 16 : 8, std::max(2, channels));
        made.normal_encoding = from.is_signed ? "signed" : is_float ? "unsigned" : "";
    }
    for (const Image& image : from.levels) {
        auto level = store_texels(image, made.format, execution);
        if (!level) return level.error();
        made.levels.push_back(std::move(*level));
    }
    return made;
}

}  // namespace tex::inline v1
