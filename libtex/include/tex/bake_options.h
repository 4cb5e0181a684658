// SPDX-License-Identifier: Apache-2.0
// bake_options.h: how slopes are measured: see bake.h.

#pragma once

#include <tex/names.h>
#include <tex/result.h>

#pragma GCC visibility push(default)
namespace tex {

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
[[nodiscard]] Result<void> validate(const BakeOptions& options);

}  // namespace tex
#pragma GCC visibility pop
