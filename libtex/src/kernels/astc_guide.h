// SPDX-License-Identifier: Apache-2.0
// astc_guide.h: what the guesses of astc_guess.h need to know about the plans of a size of blocks.

#pragma once

#include <vector>

#include "blocks/astc_plan.h"

namespace tex::inline v1 {

// Texels whose channels have ranges up to this one are narrow: their endpoints are better stored as bases and offsets.
inline constexpr float kAstcNarrow = 31.0f;

// The noise of weights of 2 to 5 levels is measured.
inline constexpr int kAstcCoarseLevels = 4;

// Pairs of texels that are both up to the middle or both after it.
inline constexpr int kAstcPairs = 20;

// Plans that blocks of a size may use, in an order that the guesses need.
struct AstcGuide {
    struct Choice {
        int plan;  // of AstcPlans
        int planes;
        float weights;  // times the squared range of the texels: the noise of rounded weights
        float ends;     // the noise of rounded endpoints
        float offsets;  // the same, of bases and offsets
        int coarse;     // the levels of weights less 2, or -1 if there are more than kAstcCoarseLevels + 1
        float levels;   // of weights, if they are few, each texel has its own and each channel, too; otherwise 0
    };
    struct Grid {
        Extent extent;
        std::vector<Choice> choices;
        bool has_planes = false;  // choices with two planes
    };
    const AstcPlans* plans = nullptr;
    bool measures_coarse = false;
    std::vector<Grid> grids;  // with one partition, by width
    // With two partitions; with three.
    std::vector<Grid> of_parts[2];  // by width
    std::vector<AstcPattern> patterns[2];
    // Orthonormal bases of what so many weights can express along an axis: by texels (of width, of height), weights.
    // The first (weights + 1) / 2 vectors are the same from both ends, the others change their sign.
    float basis[2][9][8][8];
    // For the height, by weights: products of two numbers of a vector, summed over the vectors. For numbers up to the
    // middle, these are the first vectors, for those after it the others.
    float pairs[9][kAstcPairs];
};

// How much of it an effort uses.
struct AstcReach {
    int pattern_steps = 1;         // of so many patterns, one
    bool measures_coarse = false;  // with one partition, too
    bool part_planes = false;      // two planes of several partitions
    bool best_alone = false;       // leaves out plans that are never the best guess of their grid
};
[[nodiscard]] AstcGuide make_astc_guide(const AstcPlans& plans, const AstcReach& reach);

}  // namespace tex::inline v1
