// SPDX-License-Identifier: Apache-2.0

#include "checks/wall.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "rows/border_slope.h"
#include "rows/unpack_rows.h"

namespace tex::inline v1 {
namespace {

constexpr int kWallColumns = 16;  // in a line of the processor's cache
using WallSums = std::array<std::int64_t, kWallColumns>;

// Columns with their slopes to the right, or rows with their slopes upwards.
struct WallLines {
    const Stored& stored;
    bool columns;
    int x = stored.channel(Component::x), y = stored.channel(Component::y), z = stored.channel(Component::z);
    [[nodiscard]] int count() const { return columns ? stored.extent().width : stored.extent().height; }
    [[nodiscard]] int length() const { return columns ? stored.extent().height : stored.extent().width; }

    [[nodiscard]] std::int64_t slope(int i, int j) const {
        const float nx = stored.component(x, i, j), ny = stored.component(y, i, j);
        const float nz = z < 0 ? reconstruct_z(nx, ny) : stored.component(z, i, j);
        return std::isfinite(nx + ny + nz) ? BorderSlope::fixed_slope(columns ? nx : ny, nz) : 0;
    }
    // The slopes of lines `first` to `last - 1`, added.
    [[nodiscard]] WallSums sums(int first, int last) const {
        WallSums sums{};
        for (int k = 0; k < length(); k += BorderSlope::kStep) {
            for (int line = first; line < last; ++line)
                sums[static_cast<std::size_t>(line - first)] += columns ? slope(line, k) : slope(k, line);
        }
        return sums;
    }
};

double wall_of(const WallLines& lines) {
    const int last = lines.count() - 1;
    const std::int64_t border = std::max(lines.sums(0, 1)[0], lines.sums(last, last + 1)[0]);
    const int texels = (lines.length() + BorderSlope::kStep - 1) / BorderSlope::kStep;
    const double mean = static_cast<double>(border) / texels / static_cast<double>(BorderSlope::kFixed);
    if (mean < BorderSlope::kLeastWall) return 0.0;
    std::int64_t inside = 1;
    const int end = lines.count() - BorderSlope::kNear;
    for (int first = BorderSlope::kNear; first < end; first += kWallColumns) {
        const WallSums sums = lines.sums(first, std::min(end, first + kWallColumns));
        inside = std::max(inside, *std::max_element(sums.begin(), sums.end()));
        if (static_cast<double>(border) <= BorderSlope::kWall * static_cast<double>(inside)) return 0.0;
    }
    return static_cast<double>(border) / static_cast<double>(inside);
}

}  // namespace

double find_wall(const Stored& stored) {
    const Extent extent = stored.extent();
    if (std::min(extent.width, extent.height) < BorderSlope::kLeastSide) return 0.0;
    return std::max(wall_of({stored, true}), wall_of({stored, false}));
}

}  // namespace tex::inline v1
