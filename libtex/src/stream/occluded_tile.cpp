// SPDX-License-Identifier: Apache-2.0

#include "stream/occluded_tile.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "files/input_file.h"
#include "stream/occluded_heights.h"
#include "stream/terrain_rows.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

constexpr int kEverything = std::numeric_limits<int>::max() / 2;
constexpr int kMore = 8;  // texels beyond those that count: slopes, blurs and the lines of the sweep

// Calls `row` with the number of each row and its heights.
Result<void> read_rows(TerrainRows& rows, const Execution& execution,
                       const std::function<void(int, const float*)>& row) {
    const Extent extent = rows.window().extent;
    std::vector<float> heights(static_cast<std::size_t>(extent.width));
    for (int j = 0; j < extent.height; ++j) {
        if (auto done = rows.decode(j, 1, reinterpret_cast<std::byte*>(heights.data())); !done) return done;
        row(j, heights.data());
        if (execution.progress && !execution.progress((j + 1.0) / extent.height))
            return Error{ErrorCode::cancelled, {}, "cancelled"};
    }
    return {};
}

// How far away the highest rise over the lowest ground stops to count: where rise = distance^2 / D.
Result<int> reach_of(const std::string& path, Strength strength, const BakeFileOptions& options,
                     const Execution& execution) {
    const double distance = options.occlusion ? static_cast<double>(options.occlusion->distance) : 0.0;
    if (distance == 0.0) return kEverything;
    Result<InputFile> file = InputFile::open(path);
    if (!file) return file.error();
    auto rows = TerrainRows::open(*file, options, kEverything, TerrainMargin::where_there);
    if (!rows) return rows.error();
    float low = std::numeric_limits<float>::max(), high = std::numeric_limits<float>::lowest();
    const int width = (*rows)->window().extent.width;
    auto done = read_rows(**rows, execution, [&](int, const float* heights) {
        for (int i = 0; i < width; ++i) {
            if (std::isnan(heights[i])) continue;
            low = std::min(low, heights[i]);
            high = std::max(high, heights[i]);
        }
    });
    if (!done) return done.error();
    if (!(high > low)) return kMore;
    const double steepest = std::max(std::abs(strength.x), std::abs(strength.y));
    const double reach = std::sqrt(distance * steepest * (static_cast<double>(high) - static_cast<double>(low)));
    return reach < 1e6 ? static_cast<int>(reach) + kMore : kEverything;
}

// The tile's part of a plane over the window.
void cut(const Plane<float>& from, const TerrainWindow& window, int first_row, Plane<float>& to) {
    for (int j = 0; j < window.tile.height; ++j)
        std::copy_n(from.row(window.top + j) + window.left, window.tile.width, to.row(first_row + j));
}

Plane<float> cut(const Plane<float>& from, const TerrainWindow& window) {
    if (from.empty()) return {};
    Plane<float> part(window.tile);
    cut(from, window, 0, part);
    return part;
}

OcclusionMaps cut(const OcclusionMaps& maps, const TerrainWindow& window) {
    OcclusionMaps part{cut(maps.occlusion, window), cut(maps.sky_view, window), {}, {}};
    if (!maps.bent.x.empty()) {
        part.bent = NormalMap(window.tile);
        cut(maps.bent.x, window, 0, part.bent.x);
        cut(maps.bent.y, window, 0, part.bent.y);
        cut(maps.bent.z, window, 0, part.bent.z);
    }
    if (maps.horizons.empty()) return part;
    // They lie one below the other, as OcclusionMaps says.
    const Extent tile = window.tile;
    const auto stacked =
        std::make_shared<Plane<float>>(Extent{tile.width, tile.height * static_cast<int>(maps.horizons.size())});
    int row = 0;
    for (const Plane<float>& horizons : maps.horizons) {
        cut(horizons, window, row, *stacked);
        part.horizons.emplace_back(tile, stacked->stride(), std::shared_ptr<float>(stacked, stacked->row(row)));
        row += tile.height;
    }
    return part;
}

// The width of what is seen on the side where the least is seen of what could count; 0 if everything is.
int seen_around(const TerrainRows& rows, int reach) {
    const TerrainWindow& window = rows.window();
    const int margins[] = {window.left, window.top, window.extent.width - window.tile.width - window.left,
                           window.extent.height - window.tile.height - window.top};
    int least = 0;
    for (const int margin : margins) {
        if (margin > 0 && margin < reach && (least == 0 || margin < least)) least = margin;
    }
    return least;
}

}  // namespace

Result<OccludedTile> occluded_tile(const std::string& path, HeightFieldHead head, const BakeFileOptions& options,
                                   const Execution& execution) {
    const Strength strength = head.ground ? Strength{1.0f, 1.0f} : Strength{head.bumpiness_x, head.bumpiness_y};
    auto reach =
        head.ground ? Result<int>(kEverything) : reach_of(path, strength, options, part_of(execution, 0.0, 0.1));
    if (!reach) return reach.error();
    Result<InputFile> file = InputFile::open(path);
    if (!file) return file.error();
    auto rows = TerrainRows::open(*file, options, *reach, TerrainMargin::where_there);
    if (!rows) return rows.error();
    const TerrainWindow window = (*rows)->window();
    Plane<float> heights(window.extent);
    const auto read = read_rows(**rows, part_of(execution, 0.1, 0.2), [&](int j, const float* row) {
        std::copy_n(row, window.extent.width, heights.row(j));
    });
    if (!read) return read.error();
    head.wrap_x = window.wrap_x;
    head.wrap_y = window.wrap_y;
    head.ground_row = -window.top;
    auto maps = occluded_heights(std::move(heights), head, options, part_of(execution, 0.2, 1.0));
    if (!maps) return maps.error().of(path);
    return OccludedTile{cut(*maps, window), seen_around(**rows, *reach)};
}

}  // namespace tex::inline v1
