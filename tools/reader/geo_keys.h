// SPDX-License-Identifier: Apache-2.0
// geo_keys.h: where a GeoTIFF lies (OGC GeoTIFF Standard 1.1, 19-008r4).

#pragma once

#include <tiffio.h>

#include "formats/stored_samples.h"

namespace tex::reader {

// Reads the tags of GeoTIFF into a grid of the model `none` if there are none.
[[nodiscard]] GridPlace read_geo_keys(TIFF* tiff);

}  // namespace tex::reader
