// SPDX-License-Identifier: Apache-2.0
// prj.h: reads .prj files, which say what the coordinates of a grid beside them are: well-known text (OGC 01-009, as
// ESRI writes it), or the older words of ARC/INFO ("Projection UTM", "Units METERS", "Zunits FEET").

#pragma once

#include <string_view>

#include "formats/stored_samples.h"

namespace tex::inline v1 {

// Sets the model, the units and the ellipsoid of a grid, as far as the text states them.
void read_prj(std::string_view text, GridPlace& place);

// Metres for one unit of length of this name ("m", "US survey foot"), in any case; 0 if it is not known.
[[nodiscard]] double metres_of(std::string_view unit);

}  // namespace tex::inline v1
