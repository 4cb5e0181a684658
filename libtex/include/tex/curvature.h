// SPDX-License-Identifier: Apache-2.0
// curvature.h: how much the surface of a normal map bends.

#pragma once

#include <tex/execution.h>
#include <tex/height_field.h>
#include <tex/image.h>
#include <tex/names.h>
#include <tex/normal_map.h>
#include <tex/result.h>

#pragma GCC visibility push(default)
namespace tex {

// What is computed, in 1/texel: bumps (and edges) are positive, dents (and grooves) negative. With the slopes p = -x /
// z to the right and q = -y / z upwards:
//
//     mean         (dx/dx + dy/dy) / 2: half the divergence of the normals' x and y. This is the mean curvature of the
//                  surface, 1 / r on a sphere of r texels (do Carmo: Differential Geometry of Curves and Surfaces,
//                  1976)
//     divergence   -(dp/dx + dq/dy) / 2: half the negative Laplacian of the heights in texel widths. Equal to mean
//     where
//                  the surface is flat, larger on slopes; linear in the heights
enum class CurvatureKind { mean, divergence };

inline constexpr Named<CurvatureKind> kCurvatureKindNames[] = {
    {CurvatureKind::mean, "mean", "the mean curvature of the surface"},
    {CurvatureKind::divergence, "divergence", "half the negative Laplacian of the heights"},
};

struct CurvatureOptions {
    CurvatureKind kind = CurvatureKind::mean;
    Wrap wrap_x = Wrap::repeat;
    Wrap wrap_y = Wrap::repeat;
};

struct Curvature {
    Plane<float> values;
    float least = 0.0f, greatest = 0.0f;
    double rms = 0.0;  // square root of the mean square
};

// Derivatives are central differences, (v[i + 1] - v[i - 1]) / 2, so the error falls with the square of the texel size.
// Beyond the border of an axis, components repeat (repeat), continue their slope (clamp: one-sided differences of first
// order), or are mirrored, with the component along the axis turned round (mirror). An axis of one texel does not bend.
//
// Texels with z below 1e-6 count as flat in `divergence`, which cannot have their slopes; so do, in both, texels with a
// component that is NaN or infinite.
//
// Errors: bad_option (the map has no texels, or more than kMaxExtent in a direction), out_of_memory, cancelled.
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] Result<Curvature> curvature(const NormalMap& map, const CurvatureOptions& options = {},
                                          const Execution& execution = {});

}  // namespace tex
#pragma GCC visibility pop
