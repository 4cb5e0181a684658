// SPDX-License-Identifier: Apache-2.0

#include <tex/pack.h>

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include <half.h>

#include "base/guard.h"
#include "base/parallel.h"
#include "kernels/encode.h"
#include "kernels/pack.h"

namespace tex {
namespace {

// Texels of a piece of work: enough to pay for handing it to a thread, few enough to stay in its cache.
constexpr int kPieceTexels = 1 << 15;

// The rows of a normal map as a format's channels.
class Rows {
public:
    Rows(const NormalMap& map, const Swizzle& swizzle, YAxis y_axis)
        : map_(map), swizzle_(swizzle), negate_y_(y_axis == YAxis::down) {}

    void channels(int j, PackChannel out[4]) const {
        for (std::size_t k = 0; k < 4; ++k) {
            switch (swizzle_[k]) {
                case Component::x: out[k] = {map_.x.row(j), false}; break;
                case Component::y: out[k] = {map_.y.row(j), negate_y_}; break;
                case Component::z: out[k] = {map_.z.row(j), false}; break;
                default: out[k] = {}; break;  // every encoding's constants are 1, but for channels that it does not store
            }
        }
    }

    [[nodiscard]] BlockRow block_row(int j) const {
        const Extent extent = map_.extent();
        BlockRow row;
        row.width = extent.width;
        row.height = std::min(4, extent.height - j);
        row.negate_y = negate_y_;
        for (int k = 0; k < 4; ++k) {
            row.x[k] = map_.x.row(j + std::min(k, row.height - 1));
            row.y[k] = map_.y.row(j + std::min(k, row.height - 1));
        }
        return row;
    }

    [[nodiscard]] Extent extent() const { return map_.extent(); }

private:
    const NormalMap& map_;
    const Swizzle swizzle_;
    const bool negate_y_;
};

std::size_t size(int n) { return static_cast<std::size_t>(n); }

// Rows [begin, end) as unorm codes. The kernel writes past a row's end, hence the row between.
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

// Rows [begin, end) as floats, or as halves rounded to nearest even by Imath.
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
            // 0 - n, not -n: a flat map holds no negative zeros.
            for (int i = 0; i < width; ++i, value += channels) {
                *value = Value(from[k].negate ? 0.0f - source[i] : source[i]);
            }
        }
        std::memcpy(out + size(j) * row_bytes, values.data(), row_bytes);
    }
}

void pack_rows(const Rows& rows, Format format, Effort effort, int begin, int end, std::byte* out) {
    const FormatInfo info = format_info(format);
    const std::size_t row_blocks = (size(rows.extent().width) + 3) / 4;
    for (int j = begin; j < end && info.block == 4; j += 4) {
        std::byte* blocks = out + size(j / 4) * row_blocks * info.block_bytes;
        switch (format) {
            case Format::bc3_unorm: encode_dxt5nm(rows.block_row(j), effort, blocks); break;
            case Format::bc5_unorm: encode_bc5_unorm(rows.block_row(j), effort, blocks); break;
            case Format::bc5_snorm: encode_bc5_snorm(rows.block_row(j), effort, blocks); break;
            default: assert(false && "no encoding has this format"); break;
        }
    }
    if (info.block == 4) return;
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

Result<Texture> pack_chain(const MipChain& chain, const PackOptions& options, const Execution& execution) {
    const EncodingInfo encoding = encoding_info(options.encoding);
    Texture texture;
    texture.format = encoding.format;
    texture.swizzle = encoding.swizzle;
    texture.swizzle_known = true;
    texture.y_axis = options.y_axis;
    texture.y_known = true;

    std::int64_t total = 0;
    for (const NormalMap& map : chain.levels) total += map.extent().texels();
    std::int64_t done = 0;
    for (std::size_t level = 0; level < chain.levels.size(); ++level) {
        const NormalMap& map = chain.levels[level];
        const Extent extent = map.extent();
        assert(extent == level_extent(chain.levels[0].extent(), static_cast<int>(level)));
        Level packed;
        packed.extent = extent;
        packed.bytes.resize(level_bytes(texture.format, extent));
        const Rows rows(map, texture.swizzle, options.y_axis);
        const int grain = std::max(1, kPieceTexels / extent.width / 4) * 4;  // whole rows of blocks
        const auto fraction = [&] { return static_cast<double>(done) / static_cast<double>(total); };
        ProgressSpan span;
        span.from = fraction();
        done += extent.texels();
        span.to = fraction();
        const Result<void> result = parallel_for(
            execution, extent.height, grain,
            [&](int begin, int end) {
                pack_rows(rows, texture.format, options.effort, begin, end, packed.bytes.data());
            },
            span);
        if (!result) return result.error();
        texture.levels.push_back(std::move(packed));
    }
    return texture;
}

}  // namespace

Result<Texture> pack(const MipChain& chain, const PackOptions& options, const Execution& execution) {
    assert(!chain.levels.empty());
    return guarded([&]() -> Result<Texture> { return pack_chain(chain, options, execution); });
}

}  // namespace tex
