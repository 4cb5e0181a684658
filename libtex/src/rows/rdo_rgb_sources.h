// SPDX-License-Identifier: Apache-2.0
// rdo_rgb_sources.h: which earlier blocks in the window a block of BC7 or UASTC should copy, as a whole or but for its
// indices.
//
// All earlier blocks are scored by estimates from x and y (kernels/astc_copies.h): of blocks with one subset, whose
// entries lie along a line or in a rectangle. What is left of the bound is measured.

#pragma once

#include <cstddef>
#include <vector>

#include "kernels/astc_copies.h"
#include "rows/rdo_rgb_band.h"

namespace tex::inline v1 {

// A block that searches.
struct RdoRgbSearcher {
    int number;
    const RdoRgbBlock* block;
    float scale;  // from the root of the squared error of x and y to the sum of angles, in degrees
    float cost;   // of the block without optimisation
};

class RdoRgbSources {
public:
    // `window` is in bytes, `most` the number of blocks of the band. Throws std::bad_alloc.
    RdoRgbSources(int window, std::size_t most);

    void set_lambda(float lambda);
    // The next block of the band.
    void add(const RdoRgbEntries& entries, const RdoRgbTexels& decoded);
    void find(const RdoRgbSearcher& searcher);
    // What find() has found: blocks to copy as a whole, and those whose fronts are worth a copy.
    [[nodiscard]] const std::vector<int>& wholes() const { return wholes_; }
    [[nodiscard]] const std::vector<int>& fronts() const { return fronts_; }

    [[nodiscard]] const RdoRgbTexels& decoded(int at) const { return decoded_[static_cast<std::size_t>(at)]; }
    [[nodiscard]] const RdoRgbEntries& entries(int at) const { return entries_[static_cast<std::size_t>(at)]; }

private:
    [[nodiscard]] AstcCopyTable table(std::size_t first) const;
    [[nodiscard]] float squared_distance(const RdoRgbBlock& block, int at) const;
    void add_line(const RdoRgbEntries& entries);

    const int reach_;
    float lambda_ = 0.0f;
    float basis_[3][16] = {};  // of the coarse numbers of a component
    std::vector<float> coarse_[kAstcCoarse], cos_, sin_, middle_[2], half_[2], noise_, literals_;
    std::size_t count_ = 0;
    std::vector<RdoRgbTexels> decoded_;
    std::vector<RdoRgbEntries> entries_;
    std::vector<float> prices_;  // of matches in the window, the farthest first
    std::vector<float> whole_costs_, front_costs_;
    std::vector<int> wholes_, fronts_;
};

}  // namespace tex::inline v1
