// SPDX-License-Identifier: Apache-2.0
// height_traits.h: what decides how heights are baked, found by a bake that is thrown away.

#pragma once

#include <string>

#include <tex/check.h>
#include <tex/file.h>

namespace tex::cli {

struct HeightTraits {
    bool is_on_ground = false;  // they state the size of their texels, and have slopes of their own
    bool has_wall = false;      // they do not repeat
};

// What the heights in a file that was checked are; all false if they cannot be baked.
[[nodiscard]] HeightTraits traits_of(const std::string& path, const CheckReport& report, const ReadOptions& read);

}  // namespace tex::cli
