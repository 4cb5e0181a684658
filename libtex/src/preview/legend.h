// SPDX-License-Identifier: Apache-2.0
// legend.h: explains the colours of a picture.

#pragma once

#include <string>
#include <vector>

#include <tex/format.h>

#include "preview/colormap.h"
#include "preview/vector.h"

namespace tex::inline v1::render {

// Values from `least` to `greatest`, in viridis, in the diverging colours (then least = -greatest), in grey, or in
// inferno.
enum class Palette { viridis, diverging, grey, inferno };
struct ColorScale {
    std::string title;
    double least = 0.0, greatest = 1.0;
    Palette palette = Palette::viridis;

    // Display colour of a value. All palettes except grey have 240 steps from `least` to `greatest`.
    [[nodiscard]] Vec3 color(double value) const;
};

// Three significant digits in the shortest form, the same in every locale.
[[nodiscard]] std::string number(double value);

// A bar of the colours with the values at its ends and the title between them: a picture of `width` pixels by
// kLegendRows times `unit` rows. If there is no room for the title between the values, it is shortened or put below
// them, which adds rows.
enum class Title { between_values, may_be_below };
inline constexpr int kLegendRows = 36;
[[nodiscard]] Level legend(int width, int unit, const ColorScale& scale, Title place = Title::between_values);

// The picture with its legend below. A picture that is too narrow for a legend gets wider.
[[nodiscard]] Texture with_legend(Texture picture, const ColorScale& scale);

// The picture with a line of words below, each in its colour. Words that are too long lose letters in their middles.
struct Keyword {
    std::string word;
    Code color;
};
[[nodiscard]] Texture with_key(Texture picture, const std::vector<Keyword>& words);

}  // namespace tex::inline v1::render
