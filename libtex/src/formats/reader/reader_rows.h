// SPDX-License-Identifier: Apache-2.0
// reader_rows.h: the rows of a picture, available while the reader process decodes it.

#pragma once

#include <memory>

#include <tex/file.h>
#include <tex/types.h>

#include "files/input_file.h"
#include "formats/row_source.h"

namespace tex::inline v1 {

// Starts the reader process on a file, which must outlive the rows. The process ends with the rows. The file's first
// bytes choose the decoder: TIFF, JPEG, HDR, PSD, GIF, WebP, PNM, SGI, JPEG 2000, DPX, Cineon, IFF, Softimage PIC.
// Raw values, unassociated alpha, the first
// picture of several, turned as its orientation says. Integers of fewer bits than their container (12-bit TIFF) are
// converted back to code / (2^n - 1). Such pictures are read to the end first, because only all values together show
// how the bits were widened.
//
// Errors: io             the reader program is not there or cannot be started
//         bad_data       not a picture; damaged; the decoder crashed, did not end within options.reader_timeout, or
//                        returned invalid data
//         unsupported    CMYK; animated WebP; more than kMaxReaderChannels channels; too large; more memory than
//                        options.reader_memory
//         out_of_memory
Result<std::unique_ptr<RowSource>> open_reader_rows(InputFile& file, const ReadOptions& options);

}  // namespace tex::inline v1
