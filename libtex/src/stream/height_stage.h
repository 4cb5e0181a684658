// SPDX-License-Identifier: Apache-2.0
// height_stage.h: from the rows of a picture to rows of normals: heights, blurred heights, normals. The same bytes as
// height_field() without fill_invalid, followed by bake().

#pragma once

#include <string>

#include "rows/bake_rows.h"
#include "stream/flow.h"
#include "stream/open_heights.h"

namespace tex::inline v1 {

// The rows of normals, and the strength with which they are baked.
struct BakedRows {
    Stage* normals = nullptr;
    HeightFieldHead head;
};

// The number of rows above and below its own row on which a normal depends.
[[nodiscard]] int height_reach(const HeightOptions& options, const Gradient& gradient);

// Adds the stages that read the heights, which are not blurred, and returns the one that makes their rows. The
// parameters must outlive the flow. Errors of it: also bad_data if there are invalid heights.
const Stage& add_heights(Flow& flow, Heights& heights, const std::string& input);

// Adds the stages that bake the heights; the heights of a terrain's window become the normals of the tile alone. If an
// invalid height turns up, the flow only counts, and fails at its end. `heights` counts what the stages find. All
// parameters must outlive the flow.
BakedRows add_bake(Flow& flow, Heights& heights, const std::string& input, const BakeFileOptions& options,
                   const Gradient& gradient);

}  // namespace tex::inline v1
