// SPDX-License-Identifier: Apache-2.0
// blur.h: a Gaussian blur of heights.

#pragma once

#include <vector>

#include <tex/height_field.h>
#include <tex/image.h>

namespace tex {

// g(k) / sum of g, g(k) = exp(-k^2 / (2 sigma^2)), |k| <= ceil(3 sigma): element k holds what +k and -k
// weigh. Precondition: sigma > 0.
std::vector<float> gaussian_weights(double sigma);

// Rows [begin, end) of `heights` with those weights along them; beyond their ends lies what Wrap says of heights.
// Heights are cut to +-kMaxHeight (kernels/bake.h).
void blur_across(PlaneView<const float> heights, const std::vector<float>& weights, Wrap wrap_x, int begin, int end,
                 Plane<float>& across);

// The same down the columns of what blur_across() made of all rows.
void blur_down(PlaneView<const float> across, const std::vector<float>& weights, Wrap wrap_y, int begin, int end,
               Plane<float>& out);

}  // namespace tex
