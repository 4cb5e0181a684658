// SPDX-License-Identifier: Apache-2.0
// last_rows.h: the last rows of a picture, before all others: where heights repeat, the normals of the first rows need
// them.

#pragma once

#include <memory>

#include <tex/execution.h>
#include <tex/image_io.h>
#include <tex/result.h>

#include "files/input_file.h"
#include "formats/row_source.h"

namespace tex {

// The last `count` rows, as an image of that height or a little more. No row of `rows`, the picture in `file`, has been
// decoded, nor has one afterwards: a picture whose rows cannot be looked at before their turn (a PNG, which decodes
// fast) is opened and decoded once more. Precondition: 1 <= count <= the picture's height. May throw std::bad_alloc.
// Errors: those of reading, which name the file; cancelled.
Result<Image> last_rows(InputFile& file, std::unique_ptr<RowSource>& rows, const ReadOptions& options, int count,
                        const Execution& execution);

}  // namespace tex
