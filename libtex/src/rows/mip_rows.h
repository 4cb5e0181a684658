// SPDX-License-Identifier: Apache-2.0
// mip_rows.h: turns rows of one level into rows of the next, and averages into stored values.

#pragma once

#include <optional>

#include <tex/mip.h>
#include <tex/types.h>

#include "kernels/normal_row.h"
#include "rows/axis_filter.h"

namespace tex::inline v1 {

// The first level that build_mip_chain() keeps: 0, unless the base level is larger than options.max_side.
int first_level(const MipOptions& options, Extent base);

// The number of levels that it keeps.
int levels_to_build(const MipOptions& options, Extent base);

// The options for levels that are counted from the base level, if level `first` is the first that is kept.
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

// The planes that are averaged: x, y, z, or only x and y, in the slope domain.
[[nodiscard]] inline int averaged_planes(const MipOptions& options) {
    return options.domain == MipDomain::vector ? 3 : 2;
}
[[nodiscard]] inline Plane<float>& plane_of(NormalMap& map, int plane) {
    return plane == 0 ? map.x : plane == 1 ? map.y : map.z;
}
[[nodiscard]] inline const Plane<float>& plane_of(const NormalMap& map, int plane) {
    return plane == 0 ? map.x : plane == 1 ? map.y : map.z;
}

// The rows of averages from which a row of the smaller level is made. In the slope domain, those of the base level are
// computed here from its vectors and kept while they are needed.
class LevelSource {
public:
    // `filter` and `from` must outlive this object.
    LevelSource(const LevelFilter& filter, const NormalMap& from, const MipOptions& options, bool from_base);

    // Prepares the rows for row j of the smaller level.
    void prepare(int j);

    // These rows, for one plane. They stay valid until the next call.
    const float* const* window(int plane, int j);

private:
    [[nodiscard]] int slot_of(int j, int k) const;

    const LevelFilter& filter_;
    const NormalMap& from_;
    const int taps_;
    const bool converts_;
    Plane<float> p_, q_;
    WorkingVector<int> held_;  // the row of the level in each slot
    WorkingVector<const float*> window_;
};

// Makes rows of one plane with any filter: down the columns first, in whole rows, then along the row.
class MipRows {
public:
    // `filter` must outlive this object.
    explicit MipRows(const LevelFilter& filter);

    // Makes row j of the smaller level from the rows of the larger one that LevelFilter::source() names.
    void make(const float* const* rows, int j, float* out);
    // Makes rows of a caller, which end with their last texels: nothing beyond these is read or written.
    void make_exactly(const float* const* rows, int j, float* out);

private:
    const LevelFilter& filter_;
    std::optional<RowFilter> across_;  // unused if the filter halves
    WorkingVector<float> weights_;
    Plane<float> row_;  // for make_exactly()
};

}  // namespace tex::inline v1
