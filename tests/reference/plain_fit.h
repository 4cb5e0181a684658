// SPDX-License-Identifier: Apache-2.0
// plain_fit.h: the fit of one channel of a block that the encoders promise not to fall short of, and the smallest error
// that the channel can have.

#pragma once

#include <array>

namespace tex::reference {

// Values of 16 texels, in codes.
using BlockValues = std::array<double, 16>;

// Palettes between two endpoints: BC4 with 8 values and codes up to 255 (unorm) or 254 (snorm), and DXT5nm's green with
// 4 values and endpoints of 6 bits.
enum class Palette { bc4_unorm, bc4_snorm, green };

// The squared error of the plain fit: endpoints at the extremes, rounded to codes, and indices of the nearest values;
// then twice the endpoints that suit the indices best by linear least squares, rounded, with new indices. The best of
// the three counts. Halves are rounded up. Exact if all values are whole codes: numerators and denominators are whole
// numbers, and are divided once.
double plain_fit(const BlockValues& values, Palette palette);

// The smallest squared error of all endpoints, in both modes of BC4.
double least_error(const BlockValues& values, Palette palette);

}  // namespace tex::reference
