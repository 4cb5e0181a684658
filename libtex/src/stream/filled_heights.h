// SPDX-License-Identifier: Apache-2.0
// filled_heights.h: heights that depend on texels anywhere: invalid ones take the value of the nearest valid one, and
// debanded ones bend with all others. This stage needs all rows, so it reads the picture to its end and is itself a
// source of rows.

#pragma once

#include <memory>
#include <string>

#include <tex/types.h>

#include "formats/row_source.h"
#include "rows/height_source.h"
#include "rows/linear_rows.h"

namespace tex::inline v1 {

// Reads the one-channel heights of the picture `rows` as `source` and `options` say, debands and fills them. `linear`
// may be null; messages name the picture `input`. Adds what it finds to `counts` and `deband`. `with_holes` may be
// null, or gets the debanded heights, NaN where they are filled. Precondition: no row has been decoded yet. Errors:
// those of reading and of LinearRows; bad_data (no texel is valid, or one is not and options.fill_invalid is not set);
// cancelled. May throw std::bad_alloc.
Result<std::unique_ptr<RowSource>> fill_heights(RowSource& rows, const std::string& input, const HeightSource& source,
                                                const HeightOptions& options, const LinearRows* linear,
                                                const Execution& execution, HeightCounts& counts, DebandReport& deband,
                                                Plane<float>* with_holes = nullptr);

}  // namespace tex::inline v1
