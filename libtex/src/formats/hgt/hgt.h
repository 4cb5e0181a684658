// SPDX-License-Identifier: Apache-2.0
// hgt.h: reads HGT, the tiles of the Shuttle Radar Topography Mission: heights in metres as signed integers of 16 bits,
// the most significant byte first, rows from the north, -32768 where there is none (SRTM Topography, USGS/JPL, 2003:
// dds.cr.usgs.gov/srtm/version2_1/Documentation). Nothing in the file says what it is, so its name and its length do.
//
// These readers of elevation models are libtex's own, because GDAL, which reads two hundred types, loads as many
// libraries.

#pragma once

#include <memory>

#include <tex/file.h>
#include <tex/types.h>

#include "files/input_file.h"
#include "formats/row_source.h"

namespace tex::inline v1 {

// Whether a file is called .hgt, in any case.
bool is_hgt(const InputFile& file, const ReadOptions& options);

// Opens a file of 3601x3601 (one second of arc), 1801x3601 (one second, two from east to west, as in high
// latitudes) or 1201x1201 heights (three seconds). It must outlive the rows; several threads may decode at once.
// Errors: bad_data (another length), unsupported (more than options.max_texels), io, out_of_memory.
Result<std::unique_ptr<RowSource>> open_hgt(InputFile& file, const ReadOptions& options);

}  // namespace tex::inline v1
