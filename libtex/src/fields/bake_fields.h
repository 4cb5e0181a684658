// SPDX-License-Identifier: Apache-2.0
// bake_fields.h: the fields of bake.h.

#pragma once

#include <tex/bake.h>

#include "fields/field.h"

namespace tex::inline v1 {

template <Of<BakeOptions> O, class F>
void each_field(O& o, F& f) {
    f("kernel", o.kernel, kGradientKernelNames);
    f("gaussian_sigma", o.gaussian_sigma, Range{0.0, kMaxGaussianSigma, false});
}

}  // namespace tex::inline v1
