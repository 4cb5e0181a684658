// SPDX-License-Identifier: Apache-2.0
// preview_pictures.h: small maps and pictures for the tests of preview().

#pragma once

#include <algorithm>
#include <array>
#include <cstdlib>
#include <random>

#include <gtest/gtest.h>
#include <tex/preview.h>

#include "preview/canvas.h"
#include "unit/normal_maps.h"

namespace tex {

using Pixel = std::array<int, 3>;

inline Pixel pixel(const Texture& picture, int i, int j) {
    const Level& level = picture.levels.front();
    const std::size_t at =
        (static_cast<std::size_t>(j) * static_cast<std::size_t>(level.extent.width) + static_cast<std::size_t>(i)) * 3;
    return {std::to_integer<int>(level.bytes[at]), std::to_integer<int>(level.bytes[at + 1]),
            std::to_integer<int>(level.bytes[at + 2])};
}

inline MipChain constant(Extent extent, float x, float y, float z) { return chain_from(uniform_map(extent, x, y, z)); }

inline MipChain random_map(Extent extent, unsigned seed) {
    MipChain chain = constant(extent, 0.0f, 0.0f, 1.0f);
    std::mt19937 engine(seed);
    const auto next = [&] { return static_cast<float>(engine() >> 8) / 16777216.0f * 1.4f - 0.7f; };
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const float x = next(), y = next();
            chain.levels[0].x.at(i, j) = x;
            chain.levels[0].y.at(i, j) = y;
            chain.levels[0].z.at(i, j) = reconstruct_z(x, y);
        }
    }
    return chain;
}

inline Texture render_or_fail(const PreviewScene& scene, const PreviewOptions& options,
                              const Execution& execution = {}) {
    auto picture = preview(scene, options, execution);
    EXPECT_TRUE(picture) << picture.error().message();
    return picture ? std::move(*picture) : Texture{};
}

inline Execution on_threads(int count) {
    Execution execution;
    execution.threads = count;
    return execution;
}

// A picture with a single colour, and the colour of one of its texels.
inline Texture plain_picture(Extent extent, render::Code color) { return render::Canvas(extent, color).take(); }

inline render::Code code_at(const Texture& picture, int i, int j) {
    const Pixel p = pixel(picture, i, j);
    return {static_cast<std::uint8_t>(p[0]), static_cast<std::uint8_t>(p[1]), static_cast<std::uint8_t>(p[2])};
}

namespace render {
inline bool operator==(Code a, Code b) { return a.r == b.r && a.g == b.g && a.b == b.b; }
}  // namespace render

// Largest difference between two pictures, in codes.
inline int difference(const Texture& a, const Texture& b) {
    EXPECT_EQ(a.extent(), b.extent());
    int largest = 0;
    for (std::size_t k = 0; k < a.levels[0].bytes.size(); ++k) {
        largest = std::max(
            largest, std::abs(std::to_integer<int>(a.levels[0].bytes[k]) - std::to_integer<int>(b.levels[0].bytes[k])));
    }
    return largest;
}

}  // namespace tex
