// SPDX-License-Identifier: Apache-2.0
// kinds.h: what pictures hold, as check-normals --classify prints it.

#pragma once

#include <array>
#include <iterator>
#include <string>

#include <tex/check.h>
#include <tex/format.h>

namespace tex::cli {

// The layout as --swizzle takes it: its name, or the channels of x, y and z, such as "abg".
[[nodiscard]] std::string swizzle_word(const Swizzle& swizzle);

// A row: the kind, the layout and the direction of green of normals, the confidence, the name; at the end a line break.
[[nodiscard]] std::string kind_text(const CheckReport& report);

// How many pictures of each kind there are, and in how many of normals the texels show which way green points.
struct KindTotals {
    std::array<int, std::size(kPictureKindNames)> of{};
    int up = 0, down = 0;

    void add(const CheckReport& report);
    [[nodiscard]] std::string text() const;  // "3 files: 2 normals (green up in 1, down, or red left, in 0), 1 heights"
};

}  // namespace tex::cli
