// SPDX-License-Identifier: Apache-2.0
// meshes.h: small meshes as text, for tests of commands.

#pragma once

namespace tex::cli {

// A bent sheet of eight triangles over the whole map, with smooth normals.
inline constexpr const char* kSheetObj = R"(o sheet
v 0 0 0
v 1 0 0.2
v 2 0 0
v 0 1 0.1
v 1 1 0.4
v 2 1 0.1
v 0 2 0
v 1 2 0.2
v 2 2 0
vn -0.3 -0.1 1
vn 0 -0.2 1
vn 0.3 -0.1 1
vn -0.3 0 1
vn 0 0 1
vn 0.3 0 1
vn -0.3 0.1 1
vn 0 0.2 1
vn 0.3 0.1 1
vt 0 0
vt 0.5 0
vt 1 0
vt 0 0.5
vt 0.5 0.5
vt 1 0.5
vt 0 1
vt 0.5 1
vt 1 1
f 1/1/1 2/2/2 5/5/5 4/4/4
f 2/2/2 3/3/3 6/6/6 5/5/5
f 4/4/4 5/5/5 8/8/8 7/7/7
f 5/5/5 6/6/6 9/9/9 8/8/8
)";

}  // namespace tex::cli
