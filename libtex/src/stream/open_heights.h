// SPDX-License-Identifier: Apache-2.0
// open_heights.h: a picture as rows of heights.

#pragma once

#include <memory>
#include <optional>

#include <tex/pipeline.h>

#include "files/input_file.h"
#include "formats/row_source.h"
#include "rows/bake_rows.h"
#include "rows/color.h"
#include "rows/height_source.h"

namespace tex {

// A picture, and what happens to its rows before they become normals.
struct Heights {
    std::unique_ptr<RowSource> rows;
    HeightSource source;
    std::optional<LinearRows> linear;  // if the picture is in another colour space
    HeightOptions options;
    HeightCounts counts;  // found so far
    DebandReport deband;
    bool stored = false;             // as Image::stored
    std::string remark;              // as Image::remark
    std::optional<Strength> stated;  // the strength that the file states
    std::optional<Image> last;       // the last rows, if they are needed first
};

enum class RowOrder { any, from_the_top };

// Opens the picture in `file`, which must outlive the result. Heights that repeat can be baked from the top only if the
// last rows are known first. Errors: those of bake_file() that concern the picture and its options. May throw
// std::bad_alloc.
Result<Heights> open_heights(InputFile& file, RowOrder order, const BakeFileOptions& options, const Gradient& gradient,
                             const Execution& execution);

// The strength and the borders of a height field of this extent, whose file may state a strength.
HeightFieldHead head_of(Extent extent, const BakeFileOptions& options, const std::optional<Strength>& stated);

}  // namespace tex
