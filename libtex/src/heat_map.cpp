// SPDX-License-Identifier: Apache-2.0

#include <tex/check.h>

#include <algorithm>
#include <cstddef>

#include "preview/colormap.h"
#include "preview/legend.h"
#include "rows/usable.h"
#include "threads/no_throw.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

static_assert(kHeatMapLegendRows == render::kLegendRows);

// Copies the codes of a picture to planes, from row `top` on.
void copy(const Level& picture, Image& image, int top) {
    const std::byte* code = picture.bytes.data();
    for (int j = 0; j < picture.extent.height; ++j) {
        for (int i = 0; i < picture.extent.width; ++i) {
            for (Plane<float>& plane : image.planes)
                plane.at(i, top + j) = static_cast<float>(std::to_integer<int>(*code++)) / 255.0f;
        }
    }
}

}  // namespace

Result<Image> heat_map(const Plane<float>& degrees, double full_scale, const Execution& execution) {
    return no_throw(execution, [&]() -> Result<Image> {
        if (auto usable = check_usable(degrees.extent(), "the map"); !usable) return usable.error();
        if (!(full_scale > 0.0 && full_scale <= 180.0))
            return bad_option("full_scale: must be above 0 and at most 180");
        const Extent map = degrees.extent();
        const Extent extent{std::max(map.width, kHeatMapLeastWidth), map.height + kHeatMapLegendRows};
        Image image;
        for (const char* name : {"R", "G", "B"}) {
            image.planes.emplace_back(extent, 0.0f);
            image.names.emplace_back(name);
        }
        const double scale = 1.0 / full_scale;
        const auto body = [&](int begin, int end) {
            for (int j = begin; j < end; ++j) {
                for (int i = 0; i < map.width; ++i) {
                    const render::Vec3 color = render::inferno(degrees.at(i, j) * scale);
                    image.planes[0].at(i, j) = static_cast<float>(color.x);
                    image.planes[1].at(i, j) = static_cast<float>(color.y);
                    image.planes[2].at(i, j) = static_cast<float>(color.z);
                }
            }
        };
        if (auto done = parallel_for(execution, map.height, kRowsPerPiece, body); !done) return done.error();
        const render::ColorScale colors{"degrees", 0.0, full_scale, render::Palette::inferno};
        copy(render::legend(extent.width, 1, colors), image, map.height);
        return image;
    });
}

Result<Plane<float>> largest_of_cells(const Plane<float>& degrees, int side) {
    return no_throw([&]() -> Result<Plane<float>> {
        const Extent extent = degrees.extent();
        if (auto usable = check_usable(extent, "the map"); !usable) return usable.error();
        if (side < 1) return bad_option("side: must be 1 or more");
        const int longest = std::max(extent.width, extent.height), cells_along = std::min(side, longest);
        const int cell = (longest + cells_along - 1) / cells_along;
        Plane<float> cells({(extent.width + cell - 1) / cell, (extent.height + cell - 1) / cell}, 0.0f);
        for (int j = 0; j < extent.height; ++j) {
            for (int i = 0; i < extent.width; ++i) {
                float& largest = cells.at(i / cell, j / cell);
                largest = std::max(largest, degrees.at(i, j));
            }
        }
        return cells;
    });
}

}  // namespace tex::inline v1
