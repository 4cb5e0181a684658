// SPDX-License-Identifier: Apache-2.0
// sampler.h: bilinear samples of planes, row by row of a result, under an affine map of its texels.

#pragma once

#include <vector>

#include <tex/blend.h>
#include <tex/height_field.h>
#include <tex/image.h>

namespace tex {

// The place in the source, in source widths and heights from its upper left corner, of the point (x, y) of the result, in texels from its upper left
// corner: (u, v) = (u0 + ux x + uy y, v0 + vx x + vy y).
struct UvMap {
    double u0 = 0.0, ux = 0.0, uy = 0.0;
    double v0 = 0.0, vx = 0.0, vy = 0.0;
};

// The source lies over the whole result.
[[nodiscard]] UvMap stretch(Extent result);

// As a Layer says. `cosine` and `sine` are those of its rotation.
[[nodiscard]] UvMap uv_map_of(const Layer& layer, Extent result, double cosine, double sine);

// How many texels of a source lie in one texel of the result, in the direction in which they are more.
[[nodiscard]] double texels_per_texel(const UvMap& map, Extent source);

class Sampler {
public:
    Sampler(Extent source, Extent result, const UvMap& map, Wrap wrap_x, Wrap wrap_y);

    // Goes to row j of the result.
    void place(int j);
    // The samples of that row from a plane of the source's extent.
    void sample(const Plane<float>& plane, float* out) const;

private:
    // Between which texels the sample of a texel lies, and how near to the second ones.
    struct Tap {
        int left, right, upper, lower;
        float x, y;
    };

    Extent source_;
    Extent result_;
    UvMap map_;
    Wrap wrap_x_;
    Wrap wrap_y_;
    bool same_;  // the source as it is
    int row_ = 0;
    std::vector<Tap> taps_;
};

}  // namespace tex
