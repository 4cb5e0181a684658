// SPDX-License-Identifier: Apache-2.0

#include "blocks/astc_weights.h"

#include <algorithm>
#include <cstdint>

#include "blocks/astc_ise.h"

namespace tex::inline v1 {
namespace {

constexpr float kLeastSquaredLength = 1e-4f;  // of a line, in squared codes: less counts as this

// The weights of texels that put them nearest to themselves, from 0 to 1 between the endpoints, and the squared lengths
// of their lines.
struct IdealWeights {
    float weight[kAstcMostPlanned];
    float square[kAstcMostPlanned];
};

IdealWeights ideal_weights(const AstcLines& lines, int plane, int texels, const float* const values[2]) {
    const int first = lines.mode.planes == 2 ? plane : 0, last = lines.mode.planes == 2 ? plane : 1;
    IdealWeights ideal;
    for (int k = 0; k < texels; ++k) {
        float along = 0.0f, square = 0.0f;
        for (int c = first; c <= last; ++c) {
            const int* const ends = lines.ends[lines.partition[k]][c];
            const auto step = static_cast<float>(ends[1] - ends[0]);
            along += step * (values[c][k] - static_cast<float>(ends[0]));
            square += step * step;
        }
        ideal.weight[k] = square > 0.0f ? along / square : 0.0f;
        ideal.square[k] = std::max(square, kLeastSquaredLength);
    }
    return ideal;
}

// The weight that can be stored and is nearest, from 0 to 1.
float stored_weight(const AstcValues& weights, float weight) {
    const float halves = 128.0f * std::min(std::max(weight, 0.0f), 1.0f);
    return weights.nearest[static_cast<int>(halves + 0.5f)] * (1.0f / 64.0f);
}

// Divides ideal weights among those of a grid. `ideal.weight` becomes what is left of them.
void fit_grid(const AstcGrid& grid, const AstcValues& weights, IdealWeights& ideal, float* fitted) {
    if (grid.is_full) {
        for (int w = 0; w < grid.weights; ++w) fitted[w] = stored_weight(weights, ideal.weight[w]);
        return;
    }
    for (int w = 0; w < grid.weights; ++w) {
        float sum = 0.0f;
        for (int s = grid.begin[w]; s < grid.begin[w + 1]; ++s)
            sum += grid.shares[s].share * ideal.weight[grid.shares[s].texel];
        fitted[w] = sum * grid.over_sum[w];
    }
    for (int k = 0; k < grid.texels; ++k) {
        for (int s = 0; s < 4; ++s) ideal.weight[k] -= grid.infill[k][s] * (1.0f / 16.0f) * fitted[grid.around[k][s]];
    }
    constexpr int kSweeps = 3;
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        for (int w = 0; w < grid.weights; ++w) {
            float sum = 0.0f, squares = 0.0f;
            for (int s = grid.begin[w]; s < grid.begin[w + 1]; ++s) {
                const AstcShare& share = grid.shares[s];
                const float weighted = share.share * ideal.square[share.texel];
                sum += weighted * ideal.weight[share.texel];
                squares += weighted * share.share;
            }
            float best = fitted[w] + sum / squares;
            if (sweep > 0) best = stored_weight(weights, best);
            const float change = best - fitted[w];
            fitted[w] = best;
            for (int s = grid.begin[w]; s < grid.begin[w + 1]; ++s)
                ideal.weight[grid.shares[s].texel] -= grid.shares[s].share * change;
        }
    }
}

}  // namespace

void write_astc_weights(const AstcGrid& grid, const AstcLines& lines, const float* x, const float* y,
                        const std::byte* from, std::byte* block) {
    const float* const values[2] = {x, y};
    const int planes = lines.mode.planes;
    const AstcValues& weights = astc_weight_values(lines.mode.range);
    std::uint8_t stored[kAstcMostWeights] = {};
    for (int plane = 0; plane < planes; ++plane) {
        IdealWeights ideal = ideal_weights(lines, plane, grid.texels, values);
        float fitted[kAstcMostWeights];
        fit_grid(grid, weights, ideal, fitted);
        for (int w = 0; w < grid.weights; ++w)
            stored[planes * w + plane] = weights.stored[static_cast<int>(64.0f * fitted[w] + 0.5f)];
    }
    AstcBits written;
    write_astc_ise(written, 0, lines.mode.range, planes * grid.weights, stored);
    written = written.reversed();
    const AstcBits bits = read_astc_bits(from);
    const int count = 128 - lines.mode.weight_bits();  // 32 to 104
    for (int at = 0; at < count; at += 8) {
        const int some = std::min(8, count - at);
        written.put(at, some, bits.at(at, some));
    }
    write_astc_bits(written, block);
}

}  // namespace tex::inline v1
