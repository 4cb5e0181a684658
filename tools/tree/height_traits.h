// SPDX-License-Identifier: Apache-2.0
// height_traits.h: what decides how heights are baked; a bake in memory shows it.

#pragma once

#include <string>

#include <tex/check.h>
#include <tex/file.h>

namespace tex::cli {

struct HeightTraits {
    bool is_on_ground = false;  // they state the size of their texels, and have slopes of their own
    bool has_wall = false;      // they do not repeat
};

// The traits of the heights in `path`, whose check is `report`. All are false if the file cannot be read or baked.
// Writes no file.
[[nodiscard]] HeightTraits traits_of(const std::string& path, const CheckReport& report, const ReadOptions& read);

}  // namespace tex::cli
