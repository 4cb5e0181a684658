// SPDX-License-Identifier: Apache-2.0
// gltf_corners.h: the corners of triangles in the three ways in which glTF lists them.

#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tex::inline v1 {

// Corners of triangles from those of lists, strips and fans (glTF 2.0, 3.7.2.1). `mode` is 4, 5 or 6.
std::vector<std::uint32_t> triangles_of(std::vector<std::uint32_t> corners, std::int64_t mode);

// How many there are of so many indices.
std::size_t corner_count(std::size_t indices, std::int64_t mode);

}  // namespace tex::inline v1
