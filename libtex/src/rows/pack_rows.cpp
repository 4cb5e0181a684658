// SPDX-License-Identifier: Apache-2.0

#include "rows/pack_rows.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include <half.h>

#include "blocks/astc_decode.h"
#include "kernels/encode.h"
#include "kernels/encode_astc.h"
#include "kernels/pack.h"
#include "rows/other_rows.h"

namespace tex {
namespace {

// The rows of a normal map as the channels of a format.
class Rows {
public:
    Rows(const NormalMap& map, int height, const Swizzle& swizzle, YAxis y_axis)
        : map_(map), extent_{map.extent().width, height}, swizzle_(swizzle), negate_y_(y_axis == YAxis::down) {}

    void channels(int j, PackChannel out[4]) const {
        for (std::size_t k = 0; k < 4; ++k) {
            switch (swizzle_[k]) {
                case Component::x: out[k] = {map_.x.row(j)}; break;
                case Component::y: out[k] = {map_.y.row(j), negate_y_}; break;
                case Component::z: out[k] = {map_.z.row(j)}; break;
                case Component::other: out[k] = {(k == 3 ? map_.alpha : map_.blue).row(j), false, true}; break;
                default: out[k] = {}; break;  // every encoding's constants are 1, except in channels that it lacks
            }
        }
    }

    [[nodiscard]] BlockRow blocks(int j) const { return block_row(map_.x, map_.y, extent_, j, negate_y_); }

    [[nodiscard]] Extent extent() const { return extent_; }

private:
    const NormalMap& map_;
    const Extent extent_;
    const Swizzle swizzle_;
    const bool negate_y_;
};

std::size_t size(int n) { return static_cast<std::size_t>(n); }

// Packs rows [begin, end) as unorm codes. The kernel writes past the end of a row, so it writes into a separate row
// first.
template <class Code, class Kernel>
void pack_codes(const Rows& rows, int channels, int begin, int end, std::byte* out, Kernel kernel) {
    const int width = rows.extent().width;
    std::vector<Code> codes(size(channels) * size(width + kPackSlack));
    const std::size_t row_bytes = size(channels) * size(width) * sizeof(Code);
    for (int j = begin; j < end; ++j) {
        PackChannel from[4];
        rows.channels(j, from);
        kernel(from, channels, width, codes.data());
        std::memcpy(out + size(j) * row_bytes, codes.data(), row_bytes);
    }
}

// Packs rows [begin, end) as floats, or as halves that Imath rounds to nearest even.
template <class Value>
void pack_values(const Rows& rows, int channels, int begin, int end, std::byte* out) {
    const int width = rows.extent().width;
    std::vector<Value> values(size(channels) * size(width));
    const std::size_t row_bytes = values.size() * sizeof(Value);
    for (int j = begin; j < end; ++j) {
        PackChannel from[4];
        rows.channels(j, from);
        for (int k = 0; k < channels; ++k) {
            const float* source = from[k].values;
            Value* value = values.data() + k;
            // 0 - n, not -n, so that a flat map holds no negative zeros.
            for (int i = 0; i < width; ++i, value += channels) {
                *value = Value(from[k].negate ? 0.0f - source[i] : source[i]);
            }
        }
        std::memcpy(out + size(j) * row_bytes, values.data(), row_bytes);
    }
}

// Packs rows of blocks, `count` rows of texels from row j.
void pack_astc(const Rows& rows, Format format, Effort effort, int j, int count, std::byte* out) {
    const int width = rows.extent().width;
    std::vector<float> xy(2 * size(width) * size(count));
    float* to = xy.data();
    for (int k = j; k < j + count; ++k) {
        PackChannel from[4];
        rows.channels(k, from);
        const auto& [x, y] = std::pair(from[0], from[3]);
        for (int i = 0; i < width; ++i) {
            *to++ = x.values[i];
            *to++ = y.negate ? -y.values[i] : y.values[i];
        }
    }
    encode_astc(format, effort, xy.data(), {width, count}, out);
}

}  // namespace

Swizzle swizzle_with(Encoding encoding, OtherPlanes beside) {
    Swizzle swizzle = encoding_info(encoding).swizzle;
    if (beside.blue && can_hold(encoding).blue) swizzle[2] = Component::other;
    return swizzle;
}

void pack_rows(const NormalMap& map, OtherPlanes others, int height, const PackOptions& options, int begin, int end,
               std::byte* out, int band_rows, RdoTally* tally, std::byte* plain) {
    const Format format = encoding_info(options.encoding).format;
    const FormatInfo info = format_info(format);
    Swizzle channels = swizzle_with(options.encoding, others);
    if (others.alpha && can_hold(options.encoding).alpha) channels[3] = Component::other;
    const Rows rows(map, height, channels, options.y_axis);
    if (info.has_blocks()) {
        const std::size_t pitch = level_bytes(format, {rows.extent().width, 1});
        const int block = info.block.height;
        if (is_astc(format)) {
            return pack_astc(rows, format, options.effort, begin, end - begin, out + size(begin / block) * pitch);
        }
        for (int j = begin; j < end; j += block) encode_blocks(rows.blocks(j), options, out + size(j / block) * pitch);
        if (!is_optimised(options)) return;
        if (plain != nullptr) {
            const std::size_t offset = size(begin / block) * pitch;
            std::memcpy(plain + offset, out + offset, size(blocks_across(end - begin, block)) * pitch);
        }
        for (int j = begin; j < end; j += band_rows) {
            const auto row = [&](int r) { return rows.blocks(j + r * block); };
            optimise_band(row, blocks_across(std::min(band_rows, end - j), block), options,
                          out + size(j / block) * pitch, tally);
        }
        return;
    }
    if (info.bits == 8) {
        pack_codes<std::uint8_t>(rows, info.channels, begin, end, out, pack_unorm8);
    } else if (info.bits == 16 && info.sample == SampleKind::unorm) {
        pack_codes<std::uint16_t>(rows, info.channels, begin, end, out, pack_unorm16);
    } else if (info.bits == 16) {
        pack_values<Imath::half>(rows, info.channels, begin, end, out);
    } else {
        pack_values<float>(rows, info.channels, begin, end, out);
    }
}

}  // namespace tex
