// SPDX-License-Identifier: Apache-2.0
// last_rows.h: reads the last rows of a picture before all others. If heights repeat, the normals of the first rows
// need them.

#pragma once

#include <memory>

#include <tex/file.h>
#include <tex/types.h>

#include "files/input_file.h"
#include "formats/row_source.h"

namespace tex::inline v1 {

// Returns the last `count` rows as an image of that height or a little more. `rows` is the picture in `file`. No row of
// it has been decoded before the call, and none counts as decoded after it: if rows cannot be read out of turn (as in a
// PNG, which decodes fast), the picture is decoded, then opened again. Precondition: 1 <= count <= the picture's
// height. May throw std::bad_alloc. Errors: those of reading, which name the file; cancelled.
Result<Image> last_rows(InputFile& file, std::unique_ptr<RowSource>& rows, const ReadOptions& options, int count,
                        const Execution& execution);

}  // namespace tex::inline v1
