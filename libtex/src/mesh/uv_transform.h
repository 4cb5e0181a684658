// SPDX-License-Identifier: Apache-2.0
// uv_transform.h: moves UVs as a material says.

#pragma once

#include <vector>

#include <tex/mesh.h>

namespace tex::inline v1 {

// Moves UVs by the formula of UvTransform (mesh.h), in double precision. `v_axis` is that of the UVs; the formula is
// for v that points down.
void move_uvs(std::vector<Float2>& uvs, const UvTransform& transform, YAxis v_axis);

}  // namespace tex::inline v1
