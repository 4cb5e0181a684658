// SPDX-License-Identifier: Apache-2.0
// border.h: the values beyond the border of an axis (see Wrap in height_field.h), and rows of heights that include
// them.

#pragma once

#include <functional>

#include <tex/height.h>
#include <tex/types.h>

namespace tex::inline v1 {

// Returns row j of some data, 0 <= j < height. (One that captures at most two pointers allocates nothing.)
using RowOf = std::function<const float*(int j)>;

// The texel that a filter of vectors or colours reads at index i, which may be any integer, on an axis of n texels.
// Clamp repeats the border texel.
int border_index(Wrap wrap, int i, int n);

// The height at index i, which may be any integer, on an axis of n texels:
//
//     (reflected ? 2 h[edge] - h[index] : h[index]) + drift (h[edge] - h[other])
//
// Repeat and mirror need only h[index]. Clamp rotates the heights by half a turn about a border texel, again and again:
// every two half turns add twice the rise from one border to the other. On an axis of one texel, all heights are that
// of the texel.
struct HeightIndex {
    int index = 0;
    int edge = 0;
    int other = 0;
    int drift = 0;
    bool reflected = false;

    [[nodiscard]] bool plain() const { return !reflected && drift == 0; }
};
HeightIndex height_index(Wrap wrap, int i, int n);

// Returns row j, which may be any integer, of a height field whose rows are `heights`. The result is one of these rows,
// or is computed into `beyond`, which has room for whole vectors.
const float* height_row(const RowOf& heights, Extent extent, Wrap wrap, int j, float* beyond);

// Rows of a height field with `apron` more heights to the left and to the right, for filters of that radius. Rows
// beyond the top and the bottom exist too. The last `kept` rows are kept in memory, for a filter that moves down the
// field row by row.
//
// Heights are multiplied by `scale`, then limited to +-kMaxHeight (kernels/bake.h). Rows are aligned for whole vectors.
// A row may be read and written from -lead() to one whole vector past width + apron.
class HeightRows {
public:
    HeightRows(Extent extent, RowOf heights, Wrap wrap_x, Wrap wrap_y, int apron, int kept, float scale = 1.0f);
    HeightRows(PlaneView<const float> heights, Wrap wrap_x, Wrap wrap_y, int apron, int kept);

    // Computes row j, which replaces the row `kept` rows above it. Rows must be fetched from top to bottom.
    const float* fetch(int j);
    // Row j, which must be one of the last `kept` rows that were fetched. Its texels are at [-apron, width + apron).
    [[nodiscard]] const float* row(int j) const;

    [[nodiscard]] int lead() const { return lead_; }

private:
    Extent extent_;
    RowOf heights_;
    Wrap wrap_x_;
    Wrap wrap_y_;
    int apron_;
    int kept_;
    float scale_;
    int lead_;
    Plane<float> rows_;
};

// A number of floats rounded up to whole vectors.
int aligned_count(int count);

// i modulo n, in [0, n).
constexpr int wrap_around(int i, int n) {
    const int r = i % n;
    return r < 0 ? r + n : r;
}

}  // namespace tex::inline v1
