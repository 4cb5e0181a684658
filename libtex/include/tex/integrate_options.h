// SPDX-License-Identifier: Apache-2.0
// integrate_options.h: which bake a map came from: see integrate.h.

#pragma once

#include <tex/bake_options.h>
#include <tex/height_field.h>
#include <tex/result.h>

#pragma GCC visibility push(default)
namespace tex {

// The least response that lets the heights of a float map come back as integrate.h promises. Kernels that smooth much
// attenuate many frequencies, and the rounding of floats in all of them adds up.
[[nodiscard]] constexpr float least_response_of(GradientKernel kernel) {
    return kernel == GradientKernel::sobel5 || kernel == GradientKernel::gaussian ? 3e-3f : 1e-3f;
}

struct IntegrateOptions {
    BakeOptions bake;  // how slopes were measured

    // As in HeightField: the height of value 1.0 in texel widths; 1e-20 to 1e20 in magnitude.
    float bumpiness_x = 1.0f;
    float bumpiness_y = 1.0f;
    Wrap wrap_x = Wrap::repeat;
    Wrap wrap_y = Wrap::repeat;

    // Slopes of texels with a smaller z are unknown, as are those of normals that are not finite. 8 bits hold no
    // smaller z than 1/255 besides 0, and no slope above 127 to any use. Above 0, at most 1.
    float least_z = 1e-6f;
    // Frequencies at which the response of the kernel is below this fraction of a derivative's are left out: see
    // integrate.h. Rounding to 8 bits is amplified up to its inverse: 0.1 keeps that out of sight. 0: that of
    // least_response_of() the kernel.
    float least_response = 0.0f;
    // The most solutions if one is not enough; they end before if heights change by less than 1e-5 of their range.
    int most_steps = 40;
};

// Whether every option is in its range. integrate() calls it first. Errors: bad_option, which names the option.
[[nodiscard]] Result<void> validate(const IntegrateOptions& options);

}  // namespace tex
#pragma GCC visibility pop
