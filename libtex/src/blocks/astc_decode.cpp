// SPDX-License-Identifier: Apache-2.0

#include "blocks/astc_decode.h"

#include <algorithm>
#include <cstdint>
#include <optional>

#include "blocks/astc_endpoints.h"
#include "blocks/astc_ise.h"

namespace tex::inline v1 {
namespace {

constexpr int kMostPartitions = 4;
constexpr int kMostEdge = 12;
constexpr int kWeightUnit = 64;

// Texels interpolate between a weight, its neighbours and the one below: even after the last one, which counts 0.
constexpr int kPaddedWeights = kAstcMostWeights + kMostEdge + 1;

// A block that is valid and not of one colour, before its weights are interpolated.
struct Parts {
    AstcMode mode;
    int partitions = 1;
    unsigned partition_index = 0;
    int second_channel = -1;  // the channel of the second plane
    AstcEndpoints endpoints[kMostPartitions];
    std::uint8_t weights[2][kPaddedWeights];  // 0 to 64
};

void read_weights(const AstcBits& bits, Parts& parts) {
    const AstcMode& mode = parts.mode;
    std::uint8_t stored[kAstcMostWeights];
    read_astc_ise(bits.reversed(), 0, mode.range, mode.weights(), stored);
    const std::uint8_t* const meaning = kAstcMeanings.weight[mode.range];
    const int count = mode.weights() / mode.planes;
    for (int plane = 0; plane < mode.planes; ++plane) {
        std::uint8_t* const weights = parts.weights[plane];
        for (int k = 0; k < count; ++k) weights[k] = meaning[stored[mode.planes * k + plane]];
        std::fill(weights + count, weights + kPaddedWeights, std::uint8_t{0});
    }
}

// Blocks with two partitions or more have 6 bits that say whether the modes of their endpoints differ, and begin to
// name them; the others stand below the weights.
int extra_mode_bits(const AstcBits& bits, int partitions) {
    return partitions > 1 && bits.at(23, 2) != 0 ? 3 * partitions - 4 : 0;
}

void read_endpoint_modes(const AstcBits& bits, int partitions, int extra_at, int modes[kMostPartitions]) {
    if (partitions == 1) {
        modes[0] = static_cast<int>(bits.at(13, 4));
        return;
    }
    const unsigned kind = bits.at(23, 2);
    if (kind == 0) {
        std::fill_n(modes, partitions, static_cast<int>(bits.at(25, 4)));
        return;
    }
    unsigned rest = bits.at(25, 4) | bits.at(extra_at, extra_mode_bits(bits, partitions)) << 4;
    for (int p = 0; p < partitions; ++p, rest >>= 1) modes[p] = static_cast<int>(kind - 1 + (rest & 1)) * 4;
    for (int p = 0; p < partitions; ++p, rest >>= 2) modes[p] += static_cast<int>(rest & 3);
}

std::optional<Parts> read_parts(const AstcBits& bits, Extent block) {
    const std::optional<AstcMode> mode = astc_mode(bits.at(0, kAstcModeBits), block);
    if (!mode) return std::nullopt;
    Parts parts;
    parts.mode = *mode;
    parts.partitions = static_cast<int>(bits.at(11, 2)) + 1;
    if (parts.partitions == kMostPartitions && mode->planes == 2) return std::nullopt;
    if (parts.partitions > 1) parts.partition_index = bits.at(13, 10);

    int end = 128 - mode->weight_bits() - extra_mode_bits(bits, parts.partitions);
    int modes[kMostPartitions];
    read_endpoint_modes(bits, parts.partitions, end, modes);
    if (mode->planes == 2) {
        end -= 2;
        parts.second_channel = static_cast<int>(bits.at(end, 2));
    }
    int values = 0;
    for (int p = 0; p < parts.partitions; ++p) values += astc_endpoint_values(modes[p]);
    const int begin = parts.partitions == 1 ? 17 : 29;
    if (values > kAstcMostColors) return std::nullopt;
    const int range = astc_range_within(values, end - begin);
    if (range < kAstcLeastColorRange) return std::nullopt;

    std::uint8_t colors[kAstcMostColors];
    read_astc_ise(bits, begin, range, values, colors);
    for (int k = 0; k < values; ++k) colors[k] = kAstcMeanings.color[range][colors[k]];
    for (int p = 0, at = 0; p < parts.partitions; ++p) {
        parts.endpoints[p] = astc_endpoints(modes[p], colors + at);
        at += astc_endpoint_values(modes[p]);
    }
    read_weights(bits, parts);
    return parts;
}

void interpolate_weights(const AstcMode& mode, Extent block, const std::uint8_t* weights, std::uint8_t* of_texels) {
    if (mode.grid.width == block.width && mode.grid.height == block.height) {
        std::copy_n(weights, block.texels(), of_texels);
        return;
    }
    AstcInfill across[kMostEdge];
    for (int i = 0; i < block.width; ++i) across[i] = astc_infill(i, block.width, mode.grid.width);
    for (int j = 0; j < block.height; ++j) {
        const AstcInfill down = astc_infill(j, block.height, mode.grid.height);
        const std::uint8_t* const row = weights + down.first * mode.grid.width;
        const std::uint8_t* const below = row + mode.grid.width;
        for (int i = 0; i < block.width; ++i) {
            const int k = across[i].first;
            const AstcShares s = astc_shares(across[i].part, down.part);
            const int sum =
                row[k] * s.share[0] + row[k + 1] * s.share[1] + below[k] * s.share[2] + below[k + 1] * s.share[3];
            *of_texels++ = static_cast<std::uint8_t>((sum + 8) >> 4);
        }
    }
}

void fill(Extent block, const AstcTexels& texels, const float color[4]) {
    for (int c = 0; c < 4; ++c) {
        if (texels.channel[c] != nullptr) std::fill_n(texels.channel[c], block.texels(), color[c]);
    }
}

bool is_void_valid(const AstcBits& bits) {
    if (bits.at(9, 3) != 6) return false;  // low dynamic range, and two bits that are 1
    const unsigned low_s = bits.at(12, 13), high_s = bits.at(25, 13), low_t = bits.at(38, 13), high_t = bits.at(51, 13);
    return (low_s & high_s & low_t & high_t) == 0x1fff || (low_s < high_s && low_t < high_t);
}

// Values between the endpoints of one partition, as 257 e0 (64 - w) + 257 e1 w: exact in integers.
void interpolate(int e0, int e1, const std::uint8_t* weights, int count, float* values) {
    const int begin = 257 * kWeightUnit * e0 + 32, step = 257 * (e1 - e0);
    for (int k = 0; k < count; ++k) values[k] = astc_value((begin + step * weights[k]) >> 6);
}

void interpolate(const Parts& parts, int channel, const std::uint8_t* partition, const std::uint8_t* weights, int count,
                 float* values) {
    int begin[kMostPartitions] = {}, step[kMostPartitions] = {};
    for (int p = 0; p < parts.partitions; ++p) {
        const auto& color = parts.endpoints[p].color;
        begin[p] = 257 * kWeightUnit * color[0][channel] + 32;
        step[p] = 257 * (color[1][channel] - color[0][channel]);
    }
    for (int k = 0; k < count; ++k)
        values[k] = astc_value((begin[partition[k]] + step[partition[k]] * weights[k]) >> 6);
}

}  // namespace

void decode_astc(Extent block, const std::byte* bytes, const AstcTexels& texels) {
    constexpr float kMagenta[4] = {1.0f, 0.0f, 1.0f, 1.0f};
    const AstcBits bits = read_astc_bits(bytes);
    if (bits.at(0, 9) == kAstcVoid) {
        if (!is_void_valid(bits)) return fill(block, texels, kMagenta);
        float color[4];
        for (int c = 0; c < 4; ++c) color[c] = astc_value(static_cast<int>(bits.at(64 + 16 * c, 16)));
        return fill(block, texels, color);
    }
    const std::optional<Parts> parts = read_parts(bits, block);
    if (!parts) return fill(block, texels, kMagenta);

    std::uint8_t weights[2][kAstcMostTexels], partition[kAstcMostTexels];
    for (int plane = 0; plane < parts->mode.planes; ++plane)
        interpolate_weights(parts->mode, block, parts->weights[plane], weights[plane]);
    if (parts->partitions > 1) astc_partitions(block, parts->partitions, parts->partition_index, partition);
    const int count = block.width * block.height;
    for (int c = 0; c < 4; ++c) {
        float* const values = texels.channel[c];
        if (values == nullptr) continue;
        const std::uint8_t* const of_plane = weights[c == parts->second_channel ? 1 : 0];
        if (parts->partitions > 1) {
            interpolate(*parts, c, partition, of_plane, count, values);
        } else {
            interpolate(parts->endpoints[0].color[0][c], parts->endpoints[0].color[1][c], of_plane, count, values);
        }
    }
}

std::optional<AstcLines> read_astc_lines(Extent block, const std::byte* bytes) {
    constexpr int kRed = 0, kAlpha = 3;
    const AstcBits bits = read_astc_bits(bytes);
    if (bits.at(0, 9) == kAstcVoid) return std::nullopt;
    const std::optional<Parts> parts = read_parts(bits, block);
    if (!parts || parts->partitions == kMostPartitions) return std::nullopt;
    if (parts->mode.planes == 2 && parts->second_channel != kAlpha) return std::nullopt;
    AstcLines lines{parts->mode, parts->partitions};
    if (parts->partitions > 1) astc_partitions(block, parts->partitions, parts->partition_index, lines.partition);
    for (int p = 0; p < parts->partitions; ++p) {
        for (int e = 0; e < 2; ++e) {
            lines.ends[p][0][e] = parts->endpoints[p].color[e][kRed];
            lines.ends[p][1][e] = parts->endpoints[p].color[e][kAlpha];
        }
    }
    return lines;
}

}  // namespace tex::inline v1
