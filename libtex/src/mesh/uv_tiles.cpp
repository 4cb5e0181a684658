// SPDX-License-Identifier: Apache-2.0

#include "mesh/uv_tiles.h"

namespace tex::inline v1 {

int tile_of(const MeshPart& part, std::size_t triangle) {
    double u = 0.0, v = 0.0;
    for (std::size_t c = 3 * triangle; c < 3 * triangle + 3; ++c) {
        const Float2& uv = part.uvs.front()[part.indices[c]];
        u += static_cast<double>(uv.x) / 3.0;
        v += (part.v_axis == YAxis::up ? static_cast<double>(uv.y) : 1.0 - static_cast<double>(uv.y)) / 3.0;
    }
    if (!(u >= 0.0 && u < 10.0 && v >= 0.0 && v < 900.0)) return 0;
    return 1001 + static_cast<int>(u) + 10 * static_cast<int>(v);
}

bool leaves_tile(const MeshPart& part, std::size_t triangle, int tile) {
    constexpr double kSlack = 1e-4;
    const int column = (tile - 1001) % 10, row = (tile - 1001) / 10;
    const double left = column, low = row;
    for (std::size_t c = 3 * triangle; c < 3 * triangle + 3; ++c) {
        const Float2& uv = part.uvs.front()[part.indices[c]];
        const auto u = static_cast<double>(uv.x), stored = static_cast<double>(uv.y);
        const double v = part.v_axis == YAxis::up ? stored : 1.0 - stored;
        if (u < left - kSlack || u > left + 1.0 + kSlack || v < low - kSlack || v > low + 1.0 + kSlack) return true;
    }
    return false;
}

}  // namespace tex::inline v1
