// SPDX-License-Identifier: Apache-2.0
// bake_rows.h: turns rows of heights into rows of normals, from top to bottom, through a window as high as the gradient
// kernel.

#pragma once

#include <algorithm>
#include <optional>

#include <tex/bake.h>

#include "kernels/bake.h"
#include "memory/lent_memory.h"
#include "rows/border.h"

namespace tex::inline v1 {

// A gradient as one-sided weights: derivative[k - 1] is d at +k (at -k its negative), smoothing[k] is s at +k and -k.
// The forward and central kernels are plain differences of two texels, so they have no weights.
struct Gradient {
    int radius = 1;  // the number of rows that a normal needs above and below its own row
    WorkingVector<float> derivative;
    WorkingVector<float> smoothing;
    bool forward = false;

    [[nodiscard]] bool is_difference() const { return derivative.empty(); }
};

Gradient gradient_of(const BakeOptions& options);

// The number of rows in a strip: enough texels to be worth a thread, and several times the number of rows that
// neighbouring strips both compute.
inline int strip_rows(int width, int overlap) {
    constexpr int kTexels = 1 << 17;
    return std::max({1, kTexels / width, 4 * overlap});
}

// The parameters of a height field, without its heights.
struct HeightFieldHead {
    float bumpiness_x = 1.0f;
    float bumpiness_y = 1.0f;
    Wrap wrap_x = Wrap::repeat;
    Wrap wrap_y = Wrap::repeat;
    std::optional<Ground> ground = {};  // as HeightField::ground
    int ground_row = 0;                 // the row of the ground that row 0 is
};

// The strength of a field, of the row in its middle.
[[nodiscard]] inline Strength middle_strength(const HeightFieldHead& head, Extent extent) {
    const Strength given{head.bumpiness_x, head.bumpiness_y};
    if (!head.ground) return given;
    const Strength strength = strength_on_ground(*head.ground, 0.5 * (extent.height - 1));
    return {given.x * strength.x, given.y * strength.y};
}

class BakeRows {
public:
    // `first` is the first row to bake. `heights` and `gradient` must outlive this object.
    BakeRows(Extent extent, RowOf heights, const Gradient& gradient, const HeightFieldHead& head, int first);

    // Bakes row j into `out`, which has room for whole vectors. Rows must follow one another. If the heights repeat,
    // they may continue past the last row: row `height` is row 0 again.
    void bake(int j, NormalRow out);

    // Bakes a row of a caller, which ends with its last texel: nothing beyond that is written.
    void bake_exactly(int j, NormalRow out);

    // Goes on with row j, which need not follow the last one.
    void go_to(int j) { next_ = j - gradient_.radius; }

private:
    void fetch();
    void prepare(int j);
    void make(int j, int first, int count, NormalRow out);
    // What row j's differences are multiplied by.
    [[nodiscard]] Strength scale_of(int j) const;

    const Extent extent_;
    const Gradient& gradient_;
    const std::optional<Ground> ground_;
    const int ground_row_;
    const Strength scale_;  // without the ground
    HeightRows rows_;
    int next_;
    // Used by all kernels except differences. The window of rows is processed in two ways: the derivative along the row
    // is smoothed down the column, and the derivative down the column is smoothed along the row.
    Plane<float> du_;
    Plane<float> dv_;
    WorkingVector<const float*> window_rows_;
    WorkingVector<const float*> window_du_;
};

}  // namespace tex::inline v1
