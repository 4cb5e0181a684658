// SPDX-License-Identifier: Apache-2.0
// blur.h: a Gaussian blur of heights.

#pragma once

#include <vector>

#include <tex/height_field.h>
#include <tex/result.h>

#include "threads/parallel.h"

namespace tex {

// g(k) / sum of g, g(k) = exp(-k^2 / (2 sigma^2)), |k| <= ceil(3 sigma): element k holds what +k and -k
// weigh. Precondition: sigma > 0.
std::vector<float> gaussian_weights(double sigma);

// Blurs heights with gaussian_weights(sigma) along both axes; beyond the border lies what Wrap says of
// heights. Heights are cut to +-kMaxHeight (kernels/bake.h). Errors: out_of_memory, cancelled.
Result<void> blur(Plane<float>& heights, double sigma, Wrap wrap_x, Wrap wrap_y, const Execution& execution,
                  ProgressSpan span);

}  // namespace tex
