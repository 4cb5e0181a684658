// SPDX-License-Identifier: Apache-2.0
// scale.h: makes normals steeper or flatter, see tex/blend.h.

#pragma once

#include <tex/blend.h>

#include "reference/grid.h"

namespace tex::reference {

Vector scaled(Vector n, double scale, ScaleMode mode);

}  // namespace tex::reference
