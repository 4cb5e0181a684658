// SPDX-License-Identifier: Apache-2.0

#include "options/missed_texels.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace tex::cli {
namespace {

using Shade = std::array<float, 3>;

struct Shades {
    Shade missed, hit;
};

// Each texel in turn, so that any ratio of sizes works.
Image shaded(const Plane<TexelOrigin>& origin, int side, const Shades& shades) {
    const auto [width, height] = origin.extent();
    const int times = std::max(1, (std::max(width, height) + side - 1) / side);
    const Extent extent{(width + times - 1) / times, (height + times - 1) / times};
    Image image;
    for (const char* const name : {"R", "G", "B"}) {
        image.planes.emplace_back(extent);
        image.names.emplace_back(name);
    }
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            TexelOrigin most = TexelOrigin::none;
            for (int row = j * times; row < std::min(height, (j + 1) * times); ++row) {
                for (int column = i * times; column < std::min(width, (i + 1) * times); ++column) {
                    const TexelOrigin one = origin.at(column, row);
                    if (one == TexelOrigin::missed || (one == TexelOrigin::hit && most != TexelOrigin::missed))
                        most = one;
                }
            }
            const Shade shade = most == TexelOrigin::missed ? shades.missed
                                : most == TexelOrigin::hit  ? shades.hit
                                                            : Shade{};
            for (std::size_t c = 0; c < 3; ++c) image.planes[c].at(i, j) = shade[c];
        }
    }
    return image;
}

}  // namespace

Image missed_picture(const Plane<TexelOrigin>& origin, int side) {
    return shaded(origin, side, {{1.0f, 0.1f, 0.1f}, {0.4f, 0.4f, 0.4f}});
}

Image missed_mask(const Plane<TexelOrigin>& origin, int side) { return shaded(origin, side, {{1.0f, 1.0f, 1.0f}, {}}); }

}  // namespace tex::cli
