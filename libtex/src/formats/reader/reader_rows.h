// SPDX-License-Identifier: Apache-2.0
// reader_rows.h: the rows of a picture that the reader process decodes, while it decodes them.

#pragma once

#include <memory>

#include <tex/image_io.h>
#include <tex/result.h>

#include "files/input_file.h"
#include "formats/row_source.h"

namespace tex {

// Starts the reader process on a file, which must outlive the rows; it ends with them. Pictures of fewer significant
// bits than their container has are read to the end first, as only all of them tell what was done to the bits. Errors:
// those of read_with_reader() that come before the first rows.
Result<std::unique_ptr<RowSource>> open_reader_rows(InputFile& file, const ReadOptions& options);

}  // namespace tex
