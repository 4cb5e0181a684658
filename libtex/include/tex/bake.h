// SPDX-License-Identifier: Apache-2.0
// bake.h: normals of heights.

#pragma once

#include <tex/height.h>
#include <tex/types.h>

namespace tex::inline v1 {

// -- bake ----------------------------------------------------------------------------------------------------------
//
// Heights to normals.

// How slopes are measured. Each is the product of a derivative d along one axis and a smoothing s across it,
// normalised so that a plane of slope 1 gives 1:
//
//   forward    d = [0 -1 1]                 s = [1]                2 texels; shifted by half a texel
//   central    d = [-1 0 1] / 2             s = [1]                second order; a shader's difference
//   sobel      d = [-1 0 1] / 2             s = [1 2 1] / 4        Sobel, Feldman 1968
//   scharr     d = [-1 0 1] / 2             s = [3 10 3] / 16      best rotational symmetry of 3x3 (Scharr 2000)
//   prewitt    d = [-1 0 1] / 2             s = [1 1 1] / 3        Prewitt 1970
//   sobel5     d = [-1 -2 0 2 1] / 8        s = [1 4 6 4 1] / 16
//   gaussian   d = k g(k) / sum k^2 g(k)    s = g(k) / sum g(k)    g(k) = exp(-k^2 / (2 sigma^2)), |k| <= ceil(3 sigma)
//
// central equals the bilinear samples half a texel to each side in Catlike Coding, Rendering 6, 1.3.
enum class GradientKernel { forward, central, sobel, scharr, prewitt, sobel5, gaussian };

inline constexpr Named<GradientKernel> kGradientKernelNames[] = {
    {GradientKernel::forward, "forward", "difference to the next texel"},
    {GradientKernel::central, "central", "difference of both neighbours"},
    {GradientKernel::sobel, "sobel", "3x3, [1 2 1] across"},
    {GradientKernel::scharr, "scharr", "3x3, [3 10 3] across"},
    {GradientKernel::prewitt, "prewitt", "3x3, [1 1 1] across"},
    {GradientKernel::sobel5, "sobel5", "5x5, [1 4 6 4 1] across"},
    {GradientKernel::gaussian, "gaussian", "derivative of a Gaussian"},
};

// The greatest sigma of GradientKernel::gaussian, in texels.
inline constexpr float kMaxGaussianSigma = 64.0f;

struct BakeOptions {
    GradientKernel kernel = GradientKernel::central;
    float gaussian_sigma = 1.0f;  // texels, above 0 and at most kMaxGaussianSigma; only gaussian reads it
};

// Whether every option is in its range. The verbs call it first. Errors: bad_option, which names the option.
[[nodiscard]] TEX_API Result<void> validate(const BakeOptions& options);

// Tangent-space normals of a height field:
//
//     du = dh/dx in heights per texel, to the right        n = normalize(-bumpiness_x du, -bumpiness_y dv, 1)
//     dv = dh/dy in heights per texel, upwards
//
// (Blinn 1978; Catlike Coding, Rendering 6, 1.3.) Computed in float: slopes are exact to rounding, and lengths to 2
// units in the last place. Slopes are clamped to +-1e15, so that every finite height gives a finite unit normal with
// z > 0. Only if bumpiness is above 2^40 (or HeightOptions::blur_sigma above 0) are heights beyond +-1e34 limited to
// that first.
//
// Errors: bad_option  the field has no texels, or more than kMaxExtent in a direction; bumpiness is not finite; as
//                     validate(options)
//         bad_data    a height is NaN or infinite (height_field() replaces or refuses them)
//         out_of_memory, cancelled
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] TEX_API Result<NormalMap> bake(const HeightField& field, const BakeOptions& options = {},
                                             const Execution& execution = {});

// The range of slopes in a normal map: rise per texel width to the right (x) and upwards (y), -n.x / n.z and
// -n.y / n.z with z at least 1e-16 (maps that bake() did not make may have z = 0 or below). For reports: beyond +-10,
// 8 bits hold slopes badly.
struct SlopeRange {
    float min_x = 0.0f, max_x = 0.0f;
    float min_y = 0.0f, max_y = 0.0f;
};
[[nodiscard]] TEX_API SlopeRange slope_range(const NormalMap& map, const Execution& execution = {});

}  // namespace tex::inline v1
