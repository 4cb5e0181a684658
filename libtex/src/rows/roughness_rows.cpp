// SPDX-License-Identifier: Apache-2.0

#include "rows/roughness_rows.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include <half.h>

#include "kernels/encode.h"
#include "kernels/encode_astc.h"

namespace tex::inline v1 {
namespace {

// The rows of a row of blocks as 2 roughness - 1, because encoders take components of vectors.
class Components {
public:
    explicit Components(const Plane<float>& level) : level_(level), rows_(Extent{level.extent().width, kBlockEdge}) {}

    const float* row(int k, int j) {
        const float* from = level_.row(j);
        float* to = rows_.row(k);
        for (int i = 0; i < level_.extent().width; ++i) to[i] = 2.0f * from[i] - 1.0f;
        return to;
    }

private:
    const Plane<float>& level_;
    Plane<float> rows_;
};

// A block of one channel is the first half of a block of two: BC4 of BC5, EAC R11 of RG11.
template <class Encode>
void pack_blocks(const Plane<float>& level, int height, Effort effort, int begin, int end, Encode encode,
                 std::byte* out) {
    constexpr std::size_t kOne = 8, kTwo = 16;
    const int width = level.extent().width;
    const auto count = static_cast<std::size_t>(blocks_across(width));
    std::vector<std::byte> pairs(count * kTwo);
    Components components(level);
    for (int j = begin; j < end; j += kBlockEdge) {
        BlockRow row;
        row.width = width;
        row.height = std::min(kBlockEdge, height - j);
        for (int k = 0; k < kBlockEdge; ++k) {
            row.x[k] = k < row.height ? components.row(k, j + k) : row.x[k - 1];
            row.y[k] = row.x[k];
        }
        encode(row, effort, pairs.data());
        std::byte* block = out + static_cast<std::size_t>(j / kBlockEdge) * count * kOne;
        for (std::size_t k = 0; k < count; ++k) std::memcpy(block + k * kOne, pairs.data() + k * kTwo, kOne);
    }
}

void pack_astc_blocks(const Plane<float>& level, int height, Format format, Effort effort, int begin, int end,
                      std::byte* out) {
    const Extent extent{level.extent().width, std::min(end, height) - begin};
    const auto width = static_cast<std::size_t>(extent.width);
    std::vector<float> values(width * static_cast<std::size_t>(extent.height));
    for (int j = 0; j < extent.height; ++j)
        std::copy_n(level.row(begin + j), width, values.data() + width * static_cast<std::size_t>(j));
    encode_astc_luminance(format, effort, values.data(), extent, out + level_bytes(format, {extent.width, begin}));
}

template <class Code>
void pack_codes(const Plane<float>& level, int begin, int end, std::byte* out) {
    constexpr auto kTop = static_cast<float>(std::numeric_limits<Code>::max());
    const auto width = static_cast<std::size_t>(level.extent().width);
    std::vector<Code> codes(width);
    for (int j = begin; j < end; ++j) {
        std::transform(level.row(j), level.row(j) + width, codes.begin(),
                       [](float v) { return static_cast<Code>(std::clamp(v, 0.0f, 1.0f) * kTop + 0.5f); });
        std::memcpy(out + static_cast<std::size_t>(j) * width * sizeof(Code), codes.data(), width * sizeof(Code));
    }
}

template <class Value>
void pack_values(const Plane<float>& level, int begin, int end, std::byte* out) {
    const auto width = static_cast<std::size_t>(level.extent().width);
    std::vector<Value> values(width);
    for (int j = begin; j < end; ++j) {
        std::transform(level.row(j), level.row(j) + width, values.begin(), [](float v) { return Value(v); });
        std::memcpy(out + static_cast<std::size_t>(j) * width * sizeof(Value), values.data(), width * sizeof(Value));
    }
}

}  // namespace

void pack_roughness_rows(const Plane<float>& level, int height, Format format, Effort effort, int begin, int end,
                         std::byte* out) {
    if (encodes_astc(format)) return pack_astc_blocks(level, height, format, effort, begin, end, out);
    switch (format) {
        case Format::bc4_unorm: pack_blocks(level, height, effort, begin, end, encode_bc5_unorm, out); break;
        case Format::eac_r11_unorm: pack_blocks(level, height, effort, begin, end, encode_eac_unorm, out); break;
        case Format::r8_unorm: pack_codes<std::uint8_t>(level, begin, end, out); break;
        case Format::r16_unorm: pack_codes<std::uint16_t>(level, begin, end, out); break;
        case Format::r16_float: pack_values<Imath::half>(level, begin, end, out); break;
        default: pack_values<float>(level, begin, end, out); break;
    }
}

}  // namespace tex::inline v1
