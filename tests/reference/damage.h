// SPDX-License-Identifier: Apache-2.0
// damage.h: what goes wrong with normal maps, done on purpose: for tests and benches of the checks.

#pragma once

#include <vector>

#include <tex/image.h>
#include <tex/mip_chain.h>
#include <tex/texture.h>

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

// x, y, z to codes, floor((n + 1) / 2 * 255 + 0.5).
Codes codes_of(const NormalMap& map);
// A texture of one level, rgb8 or rgba8; and of several, all of the same channels.
Texture texture_of(const Codes& codes);
Texture texture_of(const std::vector<Codes>& levels);

Codes flip_green(const Codes& codes);
Codes exchange(const Codes& codes, int a, int b);  // two channels
Codes srgb_encode(const Codes& codes);             // the curve applied once too often
Codes srgb_decode(const Codes& codes);
// With an alpha of smooth blobs, 0 to 1; straight (the same RGB) or multiplied into R, G and B.
Codes with_alpha(const Codes& codes, bool premultiplied);
// What a JPEG of this quality leaves: YCbCr, chroma at half size, the tables of ITU-T T.81 annex K scaled as libjpeg
// scales them.
Codes jpeg(const Codes& codes, int quality);

// What BC1 leaves: 5:6:5 endpoints at the corners of each 4x4 block's box of colours, and two colours between them.
Codes bc1(const Codes& codes);

// The map integrated (Frankot, Chellappa 1988), y up in the map.
struct Heights {
    Extent extent;
    std::vector<double> values;
    [[nodiscard]] double range() const;
    // The distance of the lattice of slopes that `levels` grey levels over the range leave: half a level.
    [[nodiscard]] double slope_step(int levels) const { return range() / (levels - 1) / 2.0; }
};
Heights integrate(const NormalMap& map);

// Baked again from heights whose range is stored with `levels` grey levels (0: not rounded), by central differences.
NormalMap from_heights(const Heights& heights, int levels);

NormalMap crop(const NormalMap& map, int x, int y, Extent extent);

// Chains by the box filter, each level from the last one's averages.
enum class ChainFault {
    none,
    not_normalised,  // averages as they are
    shifted,         // each level averages the texels one to the left and up: half a texel of its own
    other_image,     // the levels of the map turned by half a turn
};
std::vector<Codes> chain_of(const NormalMap& map, ChainFault fault);

}  // namespace tex::reference
