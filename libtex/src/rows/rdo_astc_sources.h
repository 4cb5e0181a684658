// SPDX-License-Identifier: Apache-2.0
// rdo_astc_sources.h: which earlier blocks in the window a block of ASTC should copy, as a whole or but for its
// weights.
//
// All earlier blocks are scored by estimates (kernels/astc_copies.h); what is left of the bound is measured.

#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "blocks/astc_decode.h"
#include "blocks/astc_plan.h"
#include "kernels/astc_copies.h"
#include "kernels/copy_search.h"
#include "rows/rdo_astc_band.h"

namespace tex::inline v1 {

// A block that searches.
struct RdoAstcSearcher {
    int number;
    const RdoAstcBlock* texels;
    float scale;  // from the root of the squared error of x and y to the sum of angles, in degrees
    float cost;   // of the block without optimisation
};

class RdoAstcSources {
public:
    // `window` is in bytes, `most` the number of blocks of the band. Throws std::bad_alloc.
    RdoAstcSources(Extent block, int window, std::size_t most);

    void set_lambda(float lambda);
    // The next block of the band.
    void add(const std::byte* bytes, const RdoAstcTexels& decoded);
    void find(const RdoAstcSearcher& block);
    // What find() has found: blocks to copy as a whole, and those whose endpoints are worth a copy.
    [[nodiscard]] const std::vector<int>& wholes() const { return wholes_; }
    [[nodiscard]] const std::vector<int>& fronts() const { return fronts_; }

    [[nodiscard]] const RdoAstcTexels& decoded(int at) const { return decoded_[static_cast<std::size_t>(at)]; }
    // The lines of a block that has any, and the grid of its weights.
    [[nodiscard]] const std::optional<AstcLines>& lines(int at) const { return lines_[static_cast<std::size_t>(at)]; }
    [[nodiscard]] const AstcGrid& grid(const AstcLines& lines) const {
        return *grids_[static_cast<std::size_t>(lines.mode.grid.width)]
                      [static_cast<std::size_t>(lines.mode.grid.height)];
    }

private:
    [[nodiscard]] AstcCopyTable table(std::size_t first) const;
    [[nodiscard]] float squared_distance(const RdoAstcBlock& block, int at) const;
    void add_lines(const AstcLines& lines);

    const Extent block_;
    const int texels_, reach_;
    float lambda_ = 0.0f;
    std::array<std::array<const AstcGrid*, 9>, 9> grids_{};  // by width and height
    float basis_[3][kAstcMostPlanned] = {};                  // of the coarse numbers of a channel
    std::vector<float> coarse_[kAstcCoarse], cos_, sin_, middle_[2], half_[2], noise_, literals_;
    std::size_t count_ = 0;
    std::vector<RdoAstcTexels> decoded_;
    std::vector<std::optional<AstcLines>> lines_;
    std::vector<float> prices_;  // of matches in the window, the farthest first
    std::vector<float> whole_costs_, front_costs_;
    std::vector<int> wholes_, fronts_;
};

}  // namespace tex::inline v1
