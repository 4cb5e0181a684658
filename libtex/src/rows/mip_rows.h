// SPDX-License-Identifier: Apache-2.0
// mip_rows.h: rows of one level to rows of the next, and averages to what is stored.

#pragma once

#include <optional>
#include <vector>

#include <tex/mip.h>

#include "kernels/normal_row.h"
#include "rows/axis_filter.h"

namespace tex {

// How far level `level` has faded to flat: 0 to 1.
float fade_at(const std::optional<Fade>& fade, int level);

// Averages (in the slope domain those of x/z and y/z, and nothing in z) become what is stored, in place.
void finish_row(NormalRow row, int width, MipDomain domain, float fade);

// Makes rows of one plane by any filter: down the columns first, whole rows at a time, then across.
class MipRows {
public:
    // The filters are make_axis_filter()'s for the larger level's width and height; they must outlive this.
    MipRows(const AxisFilter& x, const AxisFilter& y, Wrap wrap_x, int width);

    // Row j of the smaller level from the y.taps rows of the larger one that begin at 2 j + y.first.
    void make(const float* const* rows, int j, float* out);

private:
    const AxisFilter& y_;
    const int width_;
    RowFilter across_;
    std::vector<float> weights_;
};

}  // namespace tex
