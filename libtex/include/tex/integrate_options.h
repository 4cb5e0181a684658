// SPDX-License-Identifier: Apache-2.0
// integrate_options.h: which bake a map came from: see integrate.h.

#pragma once

#include <tex/bake_options.h>
#include <tex/height_field.h>

#pragma GCC visibility push(default)
namespace tex {

struct IntegrateOptions {
    BakeOptions bake;  // how slopes were measured

    // As in HeightField: the height of value 1.0 in texel widths.
    float bumpiness_x = 1.0f;
    float bumpiness_y = 1.0f;
    Wrap wrap_x = Wrap::repeat;
    Wrap wrap_y = Wrap::repeat;

    // Slopes of texels with a smaller z are unknown, as are those of normals that are not finite. 8 bits hold no
    // smaller z than 1/255 besides 0, and no slope above 127 to any use.
    float least_z = 1e-6f;
    // Frequencies at which the response of the kernel is below this fraction of a derivative's are left out: see
    // integrate.h. Rounding to 8 bits is amplified up to its inverse: 0.1 keeps that out of sight.
    float least_response = 1e-3f;
    // The most solutions if one is not enough; they end before if heights change by less than 1e-5 of their range.
    int most_steps = 40;
};

}  // namespace tex
#pragma GCC visibility pop
