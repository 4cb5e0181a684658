// SPDX-License-Identifier: Apache-2.0
// stored.h: a decoded level as the rules see it: what is stored, before any repair.

#pragma once

#include <array>
#include <vector>

#include <tex/format.h>
#include <tex/image.h>
#include <tex/unpack.h>

namespace tex {

// Channels of a level and what they hold. Green is as stored: y points up where the file's does.
struct Stored {
    const Image* image = nullptr;  // R, G, B, A as decode() gives them
    Swizzle swizzle{};
    bool is_signed = false;  // values are components themselves; otherwise (n + 1) / 2
    bool in_blocks = false;  // decoded from texel blocks

    [[nodiscard]] Extent extent() const { return image->extent(); }
    // The channel that holds `component`, or -1.
    [[nodiscard]] int channel(Component component) const;
    [[nodiscard]] bool has_z() const { return channel(Component::z) >= 0; }
    // A component of the normal; precondition: 0 <= channel.
    [[nodiscard]] float component(int channel, int i, int j) const {
        const float c = image->planes[static_cast<std::size_t>(channel)].at(i, j);
        return is_signed ? c : 2.0f * c - 1.0f;
    }
};

// A rectangle of texels; x to the right, y down from the top row.
struct Rect {
    int x = 0, y = 0, width = 0, height = 0;
};

// Where the statistical rules look: the whole map up to 2^20 texels, else 16 squares of 256 texels, spread evenly, with
// corners at multiples of 16 so that grids of blocks stay in phase. Rules that count texels do not sample.
std::vector<Rect> sample_windows(Extent extent);

// Slopes p = -x/z and q = -y/z of a window, NaN where a texel holds no usable normal: not finite, shorter than 0.5, z
// below 0.05, or x^2 + y^2 above 1.04 where z is not stored.
struct Slopes {
    Plane<float> p, q;
    [[nodiscard]] Extent extent() const { return p.extent(); }
};
Slopes slopes_of(const Stored& stored, Rect window);

// Half the size, each texel the mean of the four that it covers (NaN where one of them is).
Slopes halved(const Slopes& slopes);

}  // namespace tex
