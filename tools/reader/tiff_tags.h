// SPDX-License-Identifier: Apache-2.0
// tiff_tags.h: what a TIFF says about its samples besides their layout.

#pragma once

#include <tiffio.h>

#include "reader.h"

namespace tex::reader {

// Reads the description, the orientation, and the tags of GDAL and of GeoTIFF.
void read_tags(TIFF* tiff, ReaderHeader& header);

}  // namespace tex::reader
