// SPDX-License-Identifier: Apache-2.0
// bil.h: reads ESRI's bare heights with a header in a file of their own: .bil, .bip and .bsq (ArcGIS, "BIL, BIP, and
// BSQ raster files"), which are the same for one band, and .flt, the floats of GridFloat. A reader of libtex's own, see
// hgt.h.

#pragma once

#include <memory>

#include <tex/file.h>
#include <tex/types.h>

#include "files/input_file.h"
#include "formats/row_source.h"

namespace tex::inline v1 {

// Whether a file is called .bil, .bip, .bsq or .flt, in any case.
bool is_bil(const InputFile& file, const ReadOptions& options);

// Opens such a file, which must outlive the rows; several threads may decode at once. The header has the same name with
// .hdr or .HDR. It holds a word and a value in each line, in any order and case: nrows and ncols, which must be there;
// nbands (1), nbits (8, 16, 32; by default 8, in .flt 32), pixeltype (signedint, unsignedint, float), byteorder (I or
// LSBFIRST; M or MSBFIRST, the default of GDAL, which a remark mentions), skipbytes, bandrowbytes, totalrowbytes,
// nodata or nodata_value. Other words change nothing. Integers without a pixeltype are signed if the no-data value is
// negative, as SRTM's are.
//
// Errors: io (no header), bad_data (a value that makes no sense; a file that is shorter than its header says; the
// reason names the file that is wrong), unsupported (several bands, other depths, a header of ENVI, too large),
// out_of_memory.
Result<std::unique_ptr<RowSource>> open_bil(InputFile& file, const ReadOptions& options);

}  // namespace tex::inline v1
