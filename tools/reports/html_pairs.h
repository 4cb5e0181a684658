// SPDX-License-Identifier: Apache-2.0
// html_pairs.h: pictures of two maps, for a page.

#pragma once

#include <array>
#include <string>

#include "reports/html_map.h"

namespace tex::cli {

// The left half of one map beside the right half of the other. `names` are those of both: "A", "B". Precondition: the
// maps have their chains. Errors: those of the verbs.
[[nodiscard]] Result<HtmlPicture> split_picture(const HtmlMap& a, const HtmlMap& b,
                                                const std::array<std::string, 2>& names);

// The angles between both maps; `scale` is the angle at the end of the legend.
[[nodiscard]] Result<HtmlPicture> heat_picture(const Plane<float>& degrees, double scale, const std::string& between);

}  // namespace tex::cli
