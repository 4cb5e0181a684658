// SPDX-License-Identifier: Apache-2.0
// damage.h: damages normal maps on purpose, for tests and benchmarks of the checks.

#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <tex/format.h>
#include <tex/types.h>

namespace tex::reference {

// A map of 8-bit codes, R, G, B (and A), row by row from the top.
struct Codes {
    Extent extent;
    int channels = 3;
    std::vector<unsigned char> values;
    [[nodiscard]] unsigned char& at(int i, int j, int c) {
        return values[(static_cast<std::size_t>(j) * static_cast<std::size_t>(extent.width) +
                       static_cast<std::size_t>(i)) *
                          static_cast<std::size_t>(channels) +
                      static_cast<std::size_t>(c)];
    }
    [[nodiscard]] unsigned char at(int i, int j, int c) const { return const_cast<Codes*>(this)->at(i, j, c); }
};

// Converts x, y, z to codes: floor((n + 1) / 2 * 255 + 0.5).
Codes codes_of(const NormalMap& map);
// A texture of one level, rgb8 or rgba8; and one of several levels, all with the same channels.
Texture texture_of(const Codes& codes);
Texture texture_of(const std::vector<Codes>& levels);

// The nearest code of 8 bits.
inline unsigned char rounded_code(double v) {
    return static_cast<unsigned char>(std::clamp(std::floor(v + 0.5), 0.0, 255.0));
}

Codes flip_green(const Codes& codes);
Codes exchange(const Codes& codes, int a, int b);  // two channels
template <class Curve>
Codes with_curve(Codes codes, Curve curve) {  // of a code from 0 to 255
    for (unsigned char& code : codes.values) code = static_cast<unsigned char>(curve(int{code}));
    return codes;
}
// Colours on a lattice of x and y that lie so many codes apart, turned so that x and y take many values; z follows.
Codes with_palette(const Codes& codes, double apart);
Codes srgb_encode(const Codes& codes);  // the sRGB curve, applied once too often
Codes srgb_decode(const Codes& codes);
// Adds an alpha of smooth blobs, 0 to 1: straight (the same RGB) or multiplied into R, G and B.
Codes with_alpha(const Codes& codes, bool premultiplied);
// The map after a JPEG of this quality: YCbCr, chroma at half size, the tables of ITU-T T.81 annex K scaled as in
// libjpeg.
Codes jpeg(const Codes& codes, int quality);

// The map after BC1: 5:6:5 endpoints at the corners of each 4x4 block's bounding box of colours, and two colours
// between them.
Codes bc1(const Codes& codes);

// The integral of the map (Frankot, Chellappa 1988). y is up in the map.
struct Heights {
    Extent extent;
    std::vector<double> values;
    [[nodiscard]] double range() const;
    // The spacing of the lattice of slopes that results from `levels` grey levels over the range: half a level.
    [[nodiscard]] double slope_step(int levels) const { return range() / (levels - 1) / 2.0; }
};
Heights integrate(const NormalMap& map);

// Bakes the heights again by central differences. Their range is stored with `levels` grey levels (0: not rounded).
NormalMap from_heights(const Heights& heights, int levels);

NormalMap crop(const NormalMap& map, int x, int y, Extent extent);

// The picture turned counterclockwise about its centre, by an angle from -75 to 75 degrees, with bilinear samples.
// Vectors stay as they are, which is the damage. The result is the largest square that needs no texel outside of the
// map.
NormalMap turn_picture(const NormalMap& map, double degrees);

// Chains by the box filter. Each level averages the previous one.
enum class ChainFault {
    none,
    not_normalised,  // averages without normalisation
    shifted,         // each level averages the texels one to the left and up: half a texel of that level
    other_image,     // the levels of the map rotated by 180 degrees
};
std::vector<Codes> chain_of(const NormalMap& map, ChainFault fault);

}  // namespace tex::reference
