// SPDX-License-Identifier: Apache-2.0
// asc.h: reads ESRI ASCII grids: a few words with a number each, then the heights as text, rows from the north (ArcGIS,
// "Esri ASCII raster format"). A reader of libtex's own, see hgt.h.

#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include <tex/file.h>
#include <tex/types.h>

#include "files/input_file.h"
#include "formats/row_source.h"

namespace tex::inline v1 {

// Whether a file that begins with these bytes is such a grid: its first word is one of the header's, and a number
// follows.
bool may_be_asc(std::span<const std::byte> head);

// Opens a grid: one channel, Y, floating. The words of the header come in any order and case: ncols and nrows, which
// must be there; xllcorner or xllcenter, yllcorner or yllcenter, cellsize or dx and dy; NODATA_value, by default -9999
// (as ArcGIS has it; GDAL takes such texels as heights). Heights are separated
// by any blanks and line ends, and are rounded to floats. Rows come from the top, in their order. The file must outlive
// the rows.
//
// Errors: bad_data (a word that the header does not have or has twice, a word that is not a number, too few or too many
// heights; the reason names the line), unsupported (too large), io, out_of_memory.
Result<std::unique_ptr<RowSource>> open_asc(InputFile& file, const ReadOptions& options);

}  // namespace tex::inline v1
