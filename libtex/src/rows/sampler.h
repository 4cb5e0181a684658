// SPDX-License-Identifier: Apache-2.0
// sampler.h: bilinear samples of planes, row by row of a result, under an affine map of its texels.

#pragma once

#include <cstdint>

#include <tex/height.h>
#include <tex/types.h>

#include "kernels/bilinear.h"

namespace tex::inline v1 {

// Maps a point (x, y) of the result, in texels from its upper left corner, to a place in the source, in source widths
// and heights from its upper left corner: (u, v) = (u0 + ux x + uy y, v0 + vx x + vy y).
struct UvMap {
    double u0 = 0.0, ux = 0.0, uy = 0.0;
    double v0 = 0.0, vx = 0.0, vy = 0.0;
};

// The map of a source that covers the whole result exactly once.
[[nodiscard]] UvMap stretch(Extent result);

// The place of a source on the result, without its rotation: see Layer in blend.h.
struct Placement {
    float tiling_x = 1.0f, tiling_y = 1.0f;
    float offset_x = 0.0f, offset_y = 0.0f;
};

// `cosine` and `sine` are those of the rotation.
[[nodiscard]] UvMap uv_map_of(const Placement& placement, Extent result, double cosine, double sine);

// The number of texels of a source in one texel of the result, in the direction in which that number is larger.
[[nodiscard]] double texels_per_texel(const UvMap& map, Extent source);

// Taps that own their rows.
class Taps {
public:
    Taps() = default;
    explicit Taps(int count) : texels_({count, 2}), weights_({count, 1}) {}

    [[nodiscard]] TapRow row() { return {texels_.row(0), texels_.row(1), weights_.row(0)}; }
    [[nodiscard]] int padded() const { return static_cast<int>(texels_.stride()); }

private:
    Plane<std::int32_t> texels_;
    Plane<float> weights_;
};

class Sampler {
public:
    Sampler(Extent source, Extent result, const UvMap& map, Wrap wrap_x, Wrap wrap_y);

    // Goes to row j of the result.
    void place(int j);
    // Samples that row from a plane of the source's extent. `out` has room for whole vectors.
    void sample(const Plane<float>& plane, float* out);
    // The samples of that row if they are an unchanged row of the plane; otherwise null.
    [[nodiscard]] const float* row_of(const Plane<float>& plane) const {
        return is_whole() ? plane.row(row_) : nullptr;
    }

    // Whether the samples are an unchanged row of the source.
    [[nodiscard]] bool is_whole() const { return kind_ == Kind::same; }
    // Whether all samples of a row lie between the same two rows of the source.
    [[nodiscard]] bool is_along_rows() const { return kind_ != Kind::any; }
    struct Rows {
        int upper;
        int lower;
    };
    // These two rows, and the samples between them, after place(). Precondition: is_along_rows().
    [[nodiscard]] Rows rows();
    void sample(const float* upper, const float* lower, float* out);

private:
    enum class Kind {
        same,  // the unchanged source
        axes,  // its rows are parallel to those of the result, so all rows use the same columns
        any,
    };

    Extent source_;
    Extent result_;
    UvMap map_;
    Wrap wrap_x_;
    Wrap wrap_y_;
    Kind kind_;
    int row_ = 0;  // the row of the source, for Kind::same
    Taps columns_;
    Taps rows_;                 // one tap if rows are parallel, else one for each sample
    Plane<std::int32_t> runs_;  // of the columns, if rows are parallel
};

}  // namespace tex::inline v1
