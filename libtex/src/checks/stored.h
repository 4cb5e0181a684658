// SPDX-License-Identifier: Apache-2.0
// stored.h: a decoded level as the rules see it: the stored values, before any repair.

#pragma once

#include <array>
#include <vector>

#include <tex/format.h>
#include <tex/pack.h>
#include <tex/types.h>

namespace tex::inline v1 {

struct Background;

// The channels of a level and their meaning. Green is as stored: y points up if it does in the file.
struct Stored {
    const Image* image = nullptr;  // R, G, B, A from decode()
    Swizzle swizzle{};
    bool is_signed = false;                   // values are components; otherwise (n + 1) / 2
    bool in_blocks = false;                   // decoded from texel blocks
    const Background* transparent = nullptr;  // texels that have no slopes, because alpha is 0 there; or null

    [[nodiscard]] Extent extent() const { return image->extent(); }
    // The channel that holds `component`, or -1.
    [[nodiscard]] int channel(Component component) const;
    [[nodiscard]] bool has_z() const { return channel(Component::z) >= 0; }
    // A component of the normal. Precondition: channel >= 0.
    [[nodiscard]] float component(int channel, int i, int j) const {
        const float c = image->planes[static_cast<std::size_t>(channel)].at(i, j);
        return is_signed ? c : 2.0f * c - 1.0f;
    }
};

// Whether the values of x, y and z are components, and not (n + 1) / 2: read as unpack() reads them in this range.
bool stores_signed(const Image& image, const Swizzle& swizzle, ValueRange range);

// The most by which texel blocks change a constant channel.
inline constexpr float kBlockError = 4.0f / 255.0f;

// A rectangle of texels: x to the right, y down from the top row.
struct Rect {
    int x = 0, y = 0, width = 0, height = 0;
};

// The texels that the statistical rules examine: the whole map up to 2^20 texels, otherwise 16 squares of 256 texels.
// The squares are evenly spread, with corners at multiples of 16, so that they stay in phase with grids of blocks.
// Rules that count texels do not sample.
std::vector<Rect> sample_windows(Extent extent);

// Windows of `size` texels squared: the whole map, if it has no more texels than 16 of them.
std::vector<Rect> sample_windows(Extent extent, int size);

// Slopes p = -x/z and q = -y/z of a window. They are NaN if a texel has no usable normal: it is not finite, is shorter
// than 0.5, has z below 0.05, has x^2 + y^2 above 1.04 and no stored z, or is transparent.
struct Slopes {
    Plane<float> p, q;
    [[nodiscard]] Extent extent() const { return p.extent(); }
};
Slopes slopes_of(const Stored& stored, Rect window);

// Makes the slopes near texels without a normal unusable, too: filters and block codecs have mixed these normals with
// the fill of the hole.
void widen_holes(Slopes& slopes);

inline constexpr float kLeastZ = 0.05f;  // of a usable normal

// Halves the size. Each texel is the mean of the four that it covers, or NaN if one of them is NaN.
Slopes halved(const Slopes& slopes);

}  // namespace tex::inline v1
