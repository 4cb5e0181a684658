// SPDX-License-Identifier: Apache-2.0
// colormap.h: values to the colours of a display.

#pragma once

#include <cstdint>

#include "preview/vector.h"

namespace tex::render {

// A colour as stored in an 8-bit sRGB picture.
struct Code {
    std::uint8_t r = 0, g = 0, b = 0;
};

// Display colours: sRGB values, 0 to 1, that need no further curve.

// Viridis (van der Walt, Smith 2015; CC0), 0 to 1, as the polynomial that Matt Zucker fitted ("colormaps", Shadertoy
// WlfXRN, 2019; CC0). At most 0.02 from the table. Even in lightness, and readable with any colour vision.
[[nodiscard]] Vec3 viridis(double t);

// -1 to 1: dark blue, light blue, white at 0, orange, brown. Drawn for this library; blue against orange stays apart
// for people who confuse red and green.
[[nodiscard]] Vec3 diverging(double t);

// Inferno (Smith and van der Walt 2015; CC0), 0 to 1, in ten linear pieces.
[[nodiscard]] Vec3 inferno(double t);

// All clamp t to their range and show NaN in magenta.

// The code of a display value.
[[nodiscard]] std::uint8_t display_code(double value);

// The sRGB code (IEC 61966-2-1) of linear light, exactly the nearest in sRGB values; NaN is 0.
[[nodiscard]] std::uint8_t srgb_code(double linear);

// Linear light of an sRGB value, 0 to 1.
[[nodiscard]] double srgb_to_linear(double value);

}  // namespace tex::render
