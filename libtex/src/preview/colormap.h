// SPDX-License-Identifier: Apache-2.0
// colormap.h: maps values to display colours.

#pragma once

#include <cstdint>

#include "preview/vector.h"

namespace tex::inline v1::render {

// A colour as stored in an 8-bit sRGB picture.
struct Code {
    std::uint8_t r = 0, g = 0, b = 0;
};

// Display colours: sRGB values, 0 to 1, to which no further curve is applied.

// Viridis (van der Walt, Smith 2015; CC0), 0 to 1, as the polynomial fitted by Matt Zucker ("colormaps", Shadertoy
// WlfXRN, 2019; CC0). It differs from the table by at most 0.02. Its lightness is even, and it is readable with any
// colour vision.
[[nodiscard]] Vec3 viridis(double t);

// -1 to 1: dark blue, light blue, white at 0, orange, brown. Drawn for this library. People who confuse red and green
// can still distinguish blue from orange.
[[nodiscard]] Vec3 diverging(double t);

// Inferno (Smith and van der Walt 2015; CC0), 0 to 1, in ten linear pieces.
[[nodiscard]] Vec3 inferno(double t);

// All of these clamp t to its range and show NaN in magenta.

// The code of a display value.
[[nodiscard]] std::uint8_t display_code(double value);

// The sRGB code (IEC 61966-2-1) of linear light, rounded exactly to the nearest sRGB value; 0 for NaN.
[[nodiscard]] std::uint8_t srgb_code(double linear);

// Linear light of an sRGB value, 0 to 1.
[[nodiscard]] double srgb_to_linear(double value);

}  // namespace tex::inline v1::render
