// SPDX-License-Identifier: Apache-2.0
// mip_rows.h: rows of one level to rows of the next, and averages to what is stored.

#pragma once

#include <optional>
#include <vector>

#include <tex/mip.h>

#include "kernels/normal_row.h"
#include "rows/axis_filter.h"

namespace tex {

// How many levels build_mip_chain() makes of a base level, itself included.
int levels_to_build(const MipOptions& options, Extent base);

// How far level `level` has faded to flat: 0 to 1.
float fade_at(const std::optional<Fade>& fade, int level);

// Averages (in the slope domain those of x/z and y/z, and nothing in z) become what is stored, in place.
void finish_row(NormalRow row, int width, MipDomain domain, float fade);

// The filter from one level to the next smaller one.
struct LevelFilter {
    LevelFilter(Extent from_extent, const MipOptions& options);

    // The row of the larger level that is the k-th of those that row j of the smaller one is made of, 0 <= k < y.taps.
    [[nodiscard]] int source(int j, int k) const;

    Extent from;
    Extent to;
    Wrap wrap_x;
    Wrap wrap_y;
    AxisFilter x;
    AxisFilter y;
    bool halves;  // two rows and two columns become one, nothing else
};

// Makes rows of one plane by any filter: down the columns first, whole rows at a time, then across.
class MipRows {
public:
    // `filter` must outlive this.
    explicit MipRows(const LevelFilter& filter);

    // Row j of the smaller level from those rows of the larger one that LevelFilter::source() names.
    void make(const float* const* rows, int j, float* out);

private:
    const LevelFilter& filter_;
    std::optional<RowFilter> across_;  // unless the filter halves
    std::vector<float> weights_;
};

}  // namespace tex
