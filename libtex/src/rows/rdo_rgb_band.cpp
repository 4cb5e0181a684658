// SPDX-License-Identifier: Apache-2.0

#include "rows/rdo_rgb_band.h"

#include <algorithm>
#include <cmath>

#include "blocks/extent.h"
#include "kernels/chords.h"
#include "kernels/entry_search.h"
#include "rows/codecs.h"
#include "rows/rdo_parts.h"

namespace tex::inline v1 {
namespace {

constexpr Extent kRgbBlock{4, 4};
constexpr std::ptrdiff_t kRgbBlockBytes = 16;
constexpr float kNoAlpha = 2.0f;  // alpha of 1

void set_unit(float x, float y, float z, float to[3]) {
    const float length = std::sqrt(x * x + y * y + z * z);
    const bool is_sound = length >= 1e-6f;
    to[0] = is_sound ? x / length : 0.0f;
    to[1] = is_sound ? y / length : 0.0f;
    to[2] = is_sound ? z / length : 1.0f;
}

void set_normal(float x, float y, float to[3]) {
    const RdoNormal normal = rdo_normal(x, y);
    to[0] = normal.x;
    to[1] = normal.y;
    to[2] = normal.z;
}

RdoRgbBlock read_rgb_block(const float* texels, int values, Extent extent, int column, int row) {
    RdoRgbBlock block{};
    for (int k = 0; k < 16; ++k) {
        const int i = 4 * column + k % 4, j = 4 * row + k / 4;
        const int from = std::min(j, extent.height - 1) * extent.width + std::min(i, extent.width - 1);
        const float* const texel = texels + static_cast<std::ptrdiff_t>(values) * from;
        float unit[3];
        if (values == 2)
            set_normal(texel[0], texel[1], unit);
        else
            set_unit(texel[0], texel[1], texel[2], unit);
        for (int c = 0; c < 3; ++c) block.texels.value[c][k] = unit[c];
        block.texels.value[3][k] = values == 4 ? 2.0f * std::fmin(std::fmax(texel[3], 0.0f), 1.0f) : kNoAlpha;
        block.inside[k] = i < extent.width && j < extent.height ? 1.0f : 0.0f;
        block.most[k] = kTooLong;
    }
    return block;
}

void rgb_chords(const RdoRgbBlock& block, const RdoRgbTexels& decoded, float chords[16]) {
    squared_distances(block.texels.value, decoded.value, chords);
    for (int k = 0; k < 16; ++k) chords[k] = std::sqrt(chords[k]);
}

}  // namespace

RdoRgbEntries::RdoRgbEntries(const BlockEntries& of, bool is_xy) : block(of) {
    for (int n = 0; n < block.total(); ++n) {
        const auto centred = [&](int c) { return static_cast<float>(2 * block.code[n][c] - 255); };
        float unit[3];
        if (is_xy)
            set_normal(centred(0) / 255.0f, centred(3) / 255.0f, unit);
        else
            set_unit(centred(0), centred(1), centred(2), unit);
        for (int c = 0; c < 3; ++c) value[c][n] = unit[c];
        value[3][n] = is_xy ? kNoAlpha : static_cast<float>(block.code[n][3]) * (2.0f / 255.0f);
        const int subset = n / block.count;
        row[n] = static_cast<unsigned char>(subset + (block.is_high(n % block.count) ? 3 : 0));
    }
    for (int r = 0; r < 6; ++r) {
        for (unsigned k = 0; k < 16; ++k) {
            const bool is_other = block.subset[k] != r % 3, is_anchor = r >= 3 && (block.anchors >> k & 1u) != 0;
            distances[r][k] = is_other || is_anchor ? kNoEntry : 0.0f;
        }
    }
}

void decode_rgb_entries(const RdoRgbEntries& entries, const std::byte* bytes, RdoRgbTexels& texels) {
    std::uint8_t numbers[16];
    read_entry_numbers(entries.block, bytes, numbers);
    for (int k = 0; k < 16; ++k) {
        const int n = entries.block.subset[k] * entries.block.count + numbers[k];
        for (int c = 0; c < 4; ++c) texels.value[c][k] = entries.value[c][n];
    }
}

float rgb_chord_sum(const RdoRgbBlock& block, const float squares[16]) {
    float chords[16];
    for (int k = 0; k < 16; ++k) chords[k] = std::sqrt(squares[k]);
    return chord_sum_of(chords, block.most, block.inside, 16);
}

RdoAngles rgb_angles(const RdoRgbBlock& block, const RdoRgbTexels& decoded) {
    float chords[16];
    rgb_chords(block, decoded, chords);
    return angles_of(chords, block.plain, block.inside, 16);
}

RdoRgbBand read_rgb_band(const float* texels, int height, Extent level, int first, const PackOptions& options,
                         const std::byte* blocks) {
    const WholeBlocks& codec = *whole_blocks(options.encoding);
    const Extent extent{level.width, height};
    const int across = blocks_across(extent.width, 4), count = across * blocks_across(extent.height, 4);
    RdoRgbBand band;
    band.window = options.rdo.window;
    band.read_entries = codec.read_entries;
    band.is_xy = codec.values == 2;
    band.plain.assign(blocks, blocks + kRgbBlockBytes * count);
    band.set_parts(RdoParts(level, first).of_blocks(kRgbBlock, across, count / across));
    band.blocks.reserve(static_cast<std::size_t>(count));
    for (int n = 0; n < count; ++n) {
        RdoRgbBlock& block =
            band.blocks.emplace_back(read_rgb_block(texels, codec.values, extent, n % across, n / across));
        const std::byte* const bytes = blocks + kRgbBlockBytes * n;
        RdoRgbTexels decoded;
        decode_rgb_entries(band.entries(bytes), bytes, decoded);
        rgb_chords(block, decoded, block.plain);
        block.plain_sum = rgb_angles(block, decoded).sum;
        RdoPart& part = band.part(static_cast<std::size_t>(n));
        part.plain_sum += block.plain_sum;
        for (const float inside : block.inside) part.texels += static_cast<double>(inside);
    }
    std::vector<float> longest;
    for (RdoPart& part : band.parts) {
        part.improved_sum = part.plain_sum;
        longest.push_back(longest_chord(options.rdo, part));
    }
    for (std::size_t n = 0; n < band.blocks.size(); ++n) {
        RdoRgbBlock& block = band.blocks[n];
        const float its_longest = longest[static_cast<std::size_t>(band.part_of[n])];
        for (int k = 0; k < 16; ++k) {
            if (block.inside[k] != 0.0f) block.most[k] = std::max(its_longest, block.plain[k]);
        }
    }
    return band;
}

}  // namespace tex::inline v1
