// SPDX-License-Identifier: Apache-2.0
// sampler.h: bilinear samples of planes, row by row of a result, under an affine map of its texels.

#pragma once

#include <cstdint>

#include <tex/height_field.h>
#include <tex/image.h>

#include "kernels/bilinear.h"

namespace tex {

// The place in the source, in source widths and heights from its upper left corner, of the point (x, y) of the result,
// in texels from its upper left corner: (u, v) = (u0 + ux x + uy y, v0 + vx x + vy y).
struct UvMap {
    double u0 = 0.0, ux = 0.0, uy = 0.0;
    double v0 = 0.0, vx = 0.0, vy = 0.0;
};

// The source lies over the whole result.
[[nodiscard]] UvMap stretch(Extent result);

// How a source lies on the result, but for its rotation: see Layer in blend.h.
struct Placement {
    float tiling_x = 1.0f, tiling_y = 1.0f;
    float offset_x = 0.0f, offset_y = 0.0f;
};

// `cosine` and `sine` are those of the rotation.
[[nodiscard]] UvMap uv_map_of(const Placement& placement, Extent result, double cosine, double sine);

// How many texels of a source lie in one texel of the result, in the direction in which they are more.
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
    // The samples of that row from a plane of the source's extent. `out` has room for whole vectors.
    void sample(const Plane<float>& plane, float* out);
    // The same where they are a row of the plane as it is; null elsewhere.
    [[nodiscard]] const float* row_of(const Plane<float>& plane) const {
        return is_whole() ? plane.row(row_) : nullptr;
    }

    // The samples are a row of the source as it is.
    [[nodiscard]] bool is_whole() const { return kind_ == Kind::same; }
    // The samples lie between two rows of the source.
    [[nodiscard]] bool is_along_rows() const { return kind_ != Kind::any; }
    struct Rows {
        int upper;
        int lower;
    };
    // These rows, and the samples between them, after place(). Precondition: is_along_rows().
    [[nodiscard]] Rows rows();
    void sample(const float* upper, const float* lower, float* out);

private:
    enum class Kind {
        same,  // the source as it is
        axes,  // its rows lie along those of the result: all have the same columns
        any,
    };

    Extent source_;
    Extent result_;
    UvMap map_;
    Wrap wrap_x_;
    Wrap wrap_y_;
    Kind kind_;
    int row_ = 0;  // of the source, where it is the same
    Taps columns_;
    Taps rows_;                 // one tap where rows lie along rows, else one for each sample
    Plane<std::int32_t> runs_;  // of the columns, where rows lie along rows
};

}  // namespace tex
