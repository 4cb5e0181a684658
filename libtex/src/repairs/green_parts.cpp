// SPDX-License-Identifier: Apache-2.0

#include "repairs/green_parts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace tex::inline v1 {
namespace {

// Sums over the texels on both sides of a line: of |a + b| and of |a - b|. Neighbours are alike, so the first is the
// greater one, except where one of the two is inverted.
struct Line {
    double sum = 0.0, difference = 0.0;
    void add(float a, float b) {
        sum += static_cast<double>(std::abs(a + b));
        difference += static_cast<double>(std::abs(a - b));
    }
};

// The place of the line across which y is most clearly inverted; 0 if there is none. If the median of the ratios is R,
// an inverted line has one near 1 / R; it must be below 1 / sqrt(R). Of 152 maps of wild4 with one half inverted, 136
// have such a line there, and none with one half mirrored from left to right, whose red is inverted.
int clearest(const std::vector<Line>& lines) {
    std::vector<double> ratios;
    std::size_t best = 0;
    double least = 1.0;
    for (std::size_t k = 1; k < lines.size(); ++k) {
        if (lines[k].difference <= 0.0) continue;
        ratios.push_back(lines[k].sum / lines[k].difference);
        if (ratios.back() >= least) continue;
        least = ratios.back();
        best = k;
    }
    if (best == 0) return 0;
    const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
    std::nth_element(ratios.begin(), middle, ratios.end());
    return least * least * *middle < 1.0 ? static_cast<int>(best) : 0;
}

}  // namespace

std::vector<Region> green_parts(const Stored& stored, const std::vector<Region>& few) {
    const Extent extent = stored.extent();
    const int y = stored.channel(Component::y);
    std::vector<Line> columns(static_cast<std::size_t>(extent.width)), rows(static_cast<std::size_t>(extent.height));
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const float here = stored.component(y, i, j);
            if (i > 0) columns[static_cast<std::size_t>(i)].add(stored.component(y, i - 1, j), here);
            if (j > 0) rows[static_cast<std::size_t>(j)].add(stored.component(y, i, j - 1), here);
        }
    }
    std::int64_t left = 0, above = 0;  // regions there, less those on the other side
    const int column = clearest(columns), row = clearest(rows);
    for (const Region& region : few) {
        left += 2 * region.x + region.width < 2 * column ? 1 : -1;
        above += 2 * region.y + region.height < 2 * row ? 1 : -1;
    }
    std::vector<Region> parts;
    if (column > 0)
        parts.push_back(left > 0 ? Region{0, 0, 0, column, extent.height}
                                 : Region{0, column, 0, extent.width - column, extent.height});
    if (row > 0)
        parts.push_back(above > 0 ? Region{0, 0, 0, extent.width, row}
                                  : Region{0, 0, row, extent.width, extent.height - row});
    return parts;
}

Region rest_of(const Region& part, Extent extent) {
    Region rest = part;
    if (part.width < extent.width) {
        rest.x = part.x > 0 ? 0 : part.width;
        rest.width = extent.width - part.width;
    } else {
        rest.y = part.y > 0 ? 0 : part.height;
        rest.height = extent.height - part.height;
    }
    return rest;
}

}  // namespace tex::inline v1
