// SPDX-License-Identifier: Apache-2.0
// obj.h: reads Wavefront OBJ (Advanced Visualizer Manual, appendix B1: Object Files).

#pragma once

#include <string_view>

#include <tex/mesh.h>
#include <tex/types.h>

namespace tex::inline v1 {

// Whether a text begins as an OBJ file does: with a comment or a known keyword.
bool is_obj(std::string_view head);

// `colors`: whether those of vertices are read. Errors: bad_data, without a file.
Result<Mesh> parse_obj(std::string_view text, bool colors = false);

}  // namespace tex::inline v1
