// SPDX-License-Identifier: Apache-2.0
// magnified.h: a map as a shader shows it from near.

#pragma once

#include <tex/types.h>

namespace tex::cli {

// The map enlarged to `extent` by linear interpolation between four texels, as samplers do; it repeats beyond its
// border. The vectors are made unit again.
[[nodiscard]] NormalMap magnified(const NormalMap& map, Extent extent);

}  // namespace tex::cli
