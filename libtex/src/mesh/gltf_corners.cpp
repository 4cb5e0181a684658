// SPDX-License-Identifier: Apache-2.0

#include "mesh/gltf_corners.h"

namespace tex::inline v1 {

std::vector<std::uint32_t> triangles_of(std::vector<std::uint32_t> corners, std::int64_t mode) {
    if (mode == 4) {
        corners.resize(corner_count(corners.size(), mode));  // GPUs draw no incomplete triangle
        return corners;
    }
    std::vector<std::uint32_t> result;
    for (std::size_t k = 2; k < corners.size(); ++k) {
        const std::size_t odd = mode == 5 ? k % 2 : 0;
        const std::uint32_t a = mode == 5 ? corners[k - 2] : corners[0];
        result.insert(result.end(), {a, corners[k - 1 + odd], corners[k - odd]});
    }
    return result;
}

std::size_t corner_count(std::size_t indices, std::int64_t mode) {
    if (mode == 4) return indices / 3 * 3;
    return indices < 3 ? 0 : 3 * (indices - 2);
}

}  // namespace tex::inline v1
