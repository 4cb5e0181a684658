// SPDX-License-Identifier: Apache-2.0
// astc_fit.h: fits blocks of one or two channels to a plan of ASTC, many blocks side by side.
//
// Endpoints give ideal weights, which are divided among the weights of the grid by least squares and rounded one after
// the other, so that later weights make up for the rounding of earlier ones (Gauss-Seidel, and coordinate descent).
// Weights give ideal endpoints by least squares. The two alternate. Errors are those of the decoder, exactly.

#pragma once

#include <cstdint>

#include "blocks/astc_plan.h"

namespace tex::inline v1 {

// The most blocks side by side.
inline constexpr int kAstcLanes = 16;

// Blocks side by side, by texel and block: values of each channel from 0 to 255 (of the greatest code; fractions
// count), and partitions, 0 to 2, which plans with several alone read. Aligned for vectors.
struct AstcGroup {
    const float* value[2] = {};
    const float* partition = nullptr;
    // By partition and block: 1 where endpoints are stored as bases and offsets, otherwise 0.
    const float* offset = nullptr;
    const float* turn = nullptr;  // 1 where the endpoints to begin with change places
};

// What fits each block: weights by plane, weight and block, four weights to a number, from the lowest bits; endpoints
// by partition, channel, end and block.
struct AstcFits {
    alignas(64) float error[kAstcLanes];  // squared, in units of `value`
    alignas(64) std::uint32_t weights[2][kAstcMostWeights / 4 * kAstcLanes];
    alignas(64) float ends[3][2][2][kAstcLanes];
};

struct AstcSteps {
    int insets = 3;      // for each endpoint, places to begin at, of which all pairs are weighed
    int starts = 1;      // pairs of endpoints to begin with, at most 2
    int iterations = 1;  // of weights and endpoints
    // Over the weights of a grid, before and while they are rounded. With one, later iterations round at once.
    int sweeps = 1;
    bool near_ends = false;  // weighs the endpoints beside those of least squares
    int polishes = 0;        // rounds of trying the endpoints beside the best, each with weights near the best
};

// The number of blocks that fit_astc() fits: the distance of values of neighbouring texels in the arrays above.
[[nodiscard]] int astc_lanes();

void fit_astc(const AstcPlan& plan, const AstcSteps& steps, const AstcGroup& group, AstcFits& fits);

}  // namespace tex::inline v1
