// SPDX-License-Identifier: Apache-2.0
// blur.h: a Gaussian blur of heights.

#pragma once

#include <span>

#include <tex/height.h>
#include <tex/types.h>

#include "memory/lent_memory.h"

namespace tex::inline v1 {

// g(k) / sum of g, g(k) = exp(-k^2 / (2 sigma^2)), |k| <= ceil(3 sigma): element k holds the weight of +k and of -k.
// Precondition: sigma > 0.
WorkingVector<float> gaussian_weights(double sigma);

// Blurs rows [begin, end) of `heights` along their length with those weights. Beyond the ends of a row, heights
// continue as Wrap says. Heights are limited to +-kMaxHeight (kernels/bake.h).
void blur_across(PlaneView<const float> heights, std::span<const float> weights, Wrap wrap_x, int begin, int end,
                 Plane<float>& across);

// Does the same down the columns of the result of blur_across() for all rows.
void blur_down(PlaneView<const float> across, std::span<const float> weights, Wrap wrap_y, int begin, int end,
               Plane<float>& out);

}  // namespace tex::inline v1
