// SPDX-License-Identifier: Apache-2.0
// mip_rows.h: turns rows of one level into rows of the next, and averages into stored values.

#pragma once

#include <optional>
#include <vector>

#include <tex/mip_options.h>

#include "kernels/normal_row.h"
#include "rows/axis_filter.h"

namespace tex {

// The first level that build_mip_chain() keeps: 0, unless the base level is larger than options.max_side.
int first_level(const MipOptions& options, Extent base);

// The number of levels that it keeps.
int levels_to_build(const MipOptions& options, Extent base);

// The same options for levels that are counted from the base level, if level `first` is the first that is kept.
MipOptions counted_from_base(MipOptions options, int first);

// How far level `level` has faded to flat, from 0 to 1.
float fade_at(const std::optional<Fade>& fade, int level);

// Turns averages of level `level` into stored values, in place. In the slope domain the averages are those of x/z and
// y/z, and z is unused.
void finish_row(NormalRow row, int width, const MipOptions& options, int level);

// The filter from one level to the next smaller one.
struct LevelFilter {
    LevelFilter(Extent from_extent, const MipOptions& options);

    // The k-th row of the larger level from which row j of the smaller level is made, 0 <= k < y.taps.
    [[nodiscard]] int source(int j, int k) const;

    Extent from;
    Extent to;
    Wrap wrap_x;
    Wrap wrap_y;
    AxisFilter x;
    AxisFilter y;
    bool halves;  // two rows and two columns become one, with no other case
};

// Makes rows of one plane with any filter: down the columns first, in whole rows, then along the row.
class MipRows {
public:
    // `filter` must outlive this object.
    explicit MipRows(const LevelFilter& filter);

    // Makes row j of the smaller level from the rows of the larger one that LevelFilter::source() names.
    void make(const float* const* rows, int j, float* out);

private:
    const LevelFilter& filter_;
    std::optional<RowFilter> across_;  // unused if the filter halves
    std::vector<float> weights_;
};

}  // namespace tex
