// SPDX-License-Identifier: Apache-2.0
// rdo_parts.h: the squares of a level whose mean angles rate-distortion optimisation promises.
//
// A grid of squares of 512x512 texels begins in the upper left corner of each level. A rest of less than 64 texels on
// the right or at the bottom belongs to the square beside it. The part of a square in one band has a budget of its own:
// so the promise holds for every square, wherever bands end. A block has the lambda of the part that its middle is in;
// the growth of its texels counts where they are.

#pragma once

#include <vector>

#include <tex/types.h>

namespace tex::inline v1 {

// How rows of texels are divided into bands, and where they are.
struct RdoBands {
    int rows = 4;   // of texels, in a band: see rdo_band_rows()
    Extent level;   // that the rows belong to
    int first = 0;  // the row of the level that is row 0
};

// The parts of a band that begins at row `first` of a level.
class RdoParts {
public:
    RdoParts() = default;
    RdoParts(Extent level, int first);

    // The number of the part that a texel of the band is in, from 0.
    [[nodiscard]] int at(int column, int row) const;
    // The part that the middle of each block is in, row by row, of `rows` rows of `across` blocks.
    [[nodiscard]] std::vector<int> of_blocks(Extent block, int across, int rows) const;

private:
    Extent level_;
    int first_ = 0, across_ = 1, last_down_ = 0;
};

}  // namespace tex::inline v1
