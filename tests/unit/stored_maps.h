// SPDX-License-Identifier: Apache-2.0
// stored_maps.h: decoded levels made from formulas, for tests of the statistics of check-normals.

#pragma once

#include <utility>
#include <vector>

#include "checks/stored.h"

namespace tex {

struct Texel {
    float r = 0.0f, g = 0.0f, b = 0.0f, a = 1.0f;
};

// Floats that are components of normals; x, y, z in R, G, B unless `swizzle` changes.
struct StoredMap {
    Image image;
    Swizzle swizzle = kSwizzleXyz;
    bool is_signed = true, in_blocks = false;

    template <class Make>
    StoredMap(Extent extent, Make&& make, int channels = 3) {
        for (int c = 0; c < channels; ++c) image.planes.emplace_back(extent);
        for (int j = 0; j < extent.height; ++j) {
            for (int i = 0; i < extent.width; ++i) {
                const Texel texel = make(i, j);
                const float values[] = {texel.r, texel.g, texel.b, texel.a};
                for (int c = 0; c < channels; ++c) image.planes[static_cast<std::size_t>(c)].at(i, j) = values[c];
            }
        }
    }
    [[nodiscard]] Stored stored() const { return {&image, swizzle, is_signed, in_blocks}; }
};

}  // namespace tex
