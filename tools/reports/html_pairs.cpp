// SPDX-License-Identifier: Apache-2.0

#include "reports/html_pairs.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <tex/check.h>
#include <tex/preview.h>

namespace tex::cli {
namespace {

constexpr int kPictureSide = 384;  // of the pictures of both maps

}  // namespace

Result<HtmlPicture> split_picture(const HtmlMap& a, const HtmlMap& b, const std::array<std::string, 2>& names) {
    PreviewOptions options;
    options.size = {kPictureSide, 0};
    std::vector<Panel> panels;
    for (const HtmlMap* map : {&a, &b}) {
        PreviewScene scene;
        scene.map = &map->chain;
        scene.map_without_z = map->without_z();
        auto picture = preview(scene, options);
        if (!picture) return picture.error();
        panels.push_back({std::move(*picture), names[map == &a ? 0 : 1]});
    }
    const auto split = split_view(panels[0], panels[1]);
    if (!split) return split.error();
    return html_picture(
        *split, fmt::format("{} on the left, {} on the right", names[0], names[1]),
        fmt::format("the left half of {} and the right half of {}, lit from the upper left", names[0], names[1]));
}

Result<HtmlPicture> heat_picture(const Plane<float>& degrees, double scale, const std::string& between) {
    const auto cells = largest_of_cells(degrees, kPictureSide);
    if (!cells) return cells.error();
    const auto image = heat_map(*cells, std::clamp(scale, 0.01, 180.0));
    if (!image) return image.error();
    const auto picture = picture_of(*image);
    if (!picture) return picture.error();
    return html_picture(*picture, fmt::format("angle between {}, degrees", between),
                        "the angles as a picture, black 0 to pale yellow at the legend's end");
}

}  // namespace tex::cli
