// SPDX-License-Identifier: Apache-2.0
// rdo_copies.h: which earlier blocks in the window a block of ASTC, BC7 or UASTC should copy, as a whole or but for
// what picks its entries (weights, indices).
//
// All earlier blocks are scored by estimates from x and y (kernels/astc_copies.h): of blocks whose entries lie along
// one line or in a rectangle. What is left of the bound is measured.

#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include <tex/types.h>

#include "kernels/astc_copies.h"
#include "kernels/copy_search.h"

namespace tex::inline v1 {

inline constexpr int kRdoBlockBytes = 16;

// Where the entries of a block lie. In two planes, they fill a rectangle.
struct RdoLine {
    static constexpr float kNone = 1e12f;  // the error of blocks that have no line, or several

    // Along `step`, and across by what is left of `other`.
    void set(const float middle[2], const float step[2], const float other[2], float rounding);

    float cos = 1.0f, sin = 0.0f;
    float middle[2] = {}, half[2] = {};  // along and across
    float noise = kNone;
    float literals = 0.0f;  // bytes that pick entries
};

// A block that searches.
struct RdoSearched {
    int number;
    const float *x, *y;  // of its texels
    float scale;         // from the root of the squared error of x and y to the sum of angles, in degrees
    float cost;          // of the block without optimisation
};

// How many blocks are tried whose entries may be copied, and how much more than the block as it is they may seem to
// cost: estimates err.
struct RdoReach {
    int fronts;
    float over_plain;
};

class RdoCopies {
public:
    // `window` is in bytes, `most` the number of blocks of the band. Throws std::bad_alloc.
    RdoCopies(Extent block, int window, std::size_t most);

    void set_lambda(float lambda);
    // The next block of the band: what it decodes to.
    void add(const float* x, const float* y, const RdoLine& line);
    // `degrees_of` says how many the sum of angles would have if an earlier block was copied as a whole.
    template <class Degrees>
    void find(const RdoSearched& block, RdoReach reach, const Degrees& degrees_of) {
        constexpr int kMostWholes = 4;
        const int first = block.number > reach_ ? block.number - reach_ : 0;
        const float* const prices = score(block, first);
        const float limit = reach.over_plain * block.cost;
        // Among equal costs, the later block comes first.
        CheapCopies wholes(limit, kMostWholes), fronts(limit, reach.fronts);
        for (int k = block.number - first - 1; k >= 0; --k) {
            const auto at = static_cast<std::size_t>(k);
            if (front_costs_[at] < fronts.bound()) fronts.add({front_costs_[at], first + k, 0});
            if (whole_costs_[at] < wholes.bound()) wholes.add({degrees_of(first + k) + prices[k], first + k, 0});
        }
        take(wholes, wholes_);
        take(fronts, fronts_);
    }
    // What find() has found: blocks to copy as a whole, and those whose entries are worth a copy.
    [[nodiscard]] const std::vector<int>& wholes() const { return wholes_; }
    [[nodiscard]] const std::vector<int>& fronts() const { return fronts_; }

private:
    // Bounds and estimates for all blocks from `first` on; returns the prices of their matches.
    const float* score(const RdoSearched& block, int first);
    [[nodiscard]] AstcCopyTable table(std::size_t first) const;
    void find_coarse(const float* x, const float* y, float coarse[kAstcCoarse]) const;
    static void take(const CheapCopies& from, std::vector<int>& to);

    const int texels_, reach_;
    float lambda_ = 0.0f;
    std::vector<float> basis_[3];  // of the coarse numbers of a component
    std::vector<float> coarse_[kAstcCoarse], cos_, sin_, middle_[2], half_[2], noise_, literals_;
    std::size_t count_ = 0;
    std::vector<float> prices_;  // of matches in the window, the farthest first
    std::vector<float> whole_costs_, front_costs_;
    std::vector<int> wholes_, fronts_;
};

}  // namespace tex::inline v1
