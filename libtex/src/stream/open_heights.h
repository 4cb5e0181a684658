// SPDX-License-Identifier: Apache-2.0
// open_heights.h: a picture as rows of heights.

#pragma once

#include <memory>
#include <optional>

#include <tex/pipeline.h>

#include "files/input_file.h"
#include "formats/row_source.h"
#include "rows/bake_rows.h"
#include "rows/height_source.h"
#include "rows/linear_rows.h"

namespace tex::inline v1 {

// What the rows of a tile of a terrain are: the tile, and beside it `left` columns and above it `top` rows of its
// neighbours, and as many on the other sides. A side without a neighbour has none: there the window ends with the tile,
// so that the stages continue its heights as they do at the border of the whole terrain. Where heights repeat, every
// side has a neighbour, if only the tile itself.
struct TerrainWindow {
    Extent tile;
    int left = 0, top = 0;
    Extent extent;  // of the window
    // How the stages continue the heights of the window. What they find beyond a neighbour's rows reaches no normal of
    // the tile.
    Wrap wrap_x = Wrap::clamp, wrap_y = Wrap::clamp;
};

class TerrainRows;

// A picture, and what happens to its rows before they become normals.
struct Heights {
    std::unique_ptr<RowSource> rows;
    const TerrainRows* terrain = nullptr;  // the rows, if they are a tile and what is around it, as it was read
    HeightSource source;
    std::optional<LinearRows> linear;  // if the picture is in another colour space
    HeightOptions options;
    HeightCounts counts;  // found so far
    DebandReport deband;
    bool stored = false;                  // as Image::stored
    bool assumes_no_data = false;         // as PictureHead::is_no_data_assumed, unless the options name a value
    std::string remark;                   // as Image::remark
    std::optional<Image> last;            // the last rows, if they are needed first
    std::optional<Strength> stated;       // the strength that the file states
    std::optional<Ground> ground;         // as HeightReport::ground
    std::string ground_remark;            // as HeightReport::ground_remark
    std::optional<TerrainWindow> window;  // what the rows are, if the picture is a tile of a terrain
    Plane<float> with_holes;              // if occlusion is wanted: all heights, NaN where they are filled
};

enum class RowOrder { any, from_the_top };

// Opens the picture in `file`, which must outlive the result, without anything that needs all of its rows. Errors and
// exceptions: as open_heights().
Result<Heights> open_height_rows(InputFile& file, const BakeFileOptions& options);

// Opens the picture in `file`, which must outlive the result. Heights that repeat can be baked from the top only if the
// last rows are known first. Errors: those of bake_file() that concern the picture and its options. May throw
// std::bad_alloc.
Result<Heights> open_heights(InputFile& file, RowOrder order, const BakeFileOptions& options, const Gradient& gradient,
                             const Execution& execution);

// `remark`, and what to say about missing heights once all of them have been counted.
std::string remark_with_counts(const Heights& heights, std::string remark, const HeightCounts& counts);

// What was found out about heights, of which some have been counted.
[[nodiscard]] HeightReport report_of(const Heights& heights, const HeightCounts& counts);

// The strength and the borders of a height field, or of the tile in its window.
HeightFieldHead head_of(const Heights& heights, const BakeFileOptions& options);

}  // namespace tex::inline v1
