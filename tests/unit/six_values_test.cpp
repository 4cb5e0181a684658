// SPDX-License-Identifier: Apache-2.0
// Palettes of 6 values for blocks with the lowest or the greatest code, beside the palettes that the blocks came from
// and the exhaustive search.

#include "kernels/six_values.h"

#include <algorithm>
#include <cstdint>
#include <random>

#include <gtest/gtest.h>

#include "reference/exhaustive_search.h"

namespace tex {
namespace {

// Texels of a palette with these endpoints, some of them at an extreme.
BlockTexels texels_of(int low, int high, int top, bool rounded, std::mt19937& random) {
    BlockTexels texels;
    for (std::int32_t& value : texels.values) {
        const auto k = static_cast<int>(random() % 8);
        const double code = k == 6 ? 0.0 : k == 7 ? top : low + (high - low) * k / 5.0;
        const double whole = rounded ? static_cast<double>(static_cast<int>(code + 0.5)) : code;
        value = static_cast<std::int32_t>(whole * kCodeUnit + 0.5);
    }
    return texels;
}

TEST(SixValues, FindsThePaletteThatTexelsCameFrom) {
    std::mt19937 random(4);
    for (const Bc4Codes codes : {kBc4Unorm, kBc4Snorm}) {
        std::int64_t of_palettes = 0, found = 0;
        for (int n = 0; n < 2000; ++n) {
            const bool rounded = n % 2 == 1;
            const auto a = static_cast<int>(random() % static_cast<unsigned>(codes.top + 1));
            const auto b = static_cast<int>(random() % static_cast<unsigned>(codes.top + 1));
            const BlockTexels texels = texels_of(std::min(a, b), std::max(a, b), codes.top, rounded, random);
            const std::int64_t wanted = bc4_error(texels, codes, {std::min(a, b), std::max(a, b)});
            const Bc4Endpoints fitted{codes.top, 0};
            const std::int64_t error = bc4_error(texels, codes, with_six_values(texels, codes, fitted));
            EXPECT_LE(error, bc4_error(texels, codes, fitted));
            if (rounded) {
                of_palettes += wanted;
                found += error;
            } else {
                EXPECT_LE(error, 16 * kBc4ErrorUnit / kCodeUnit * kBc4ErrorUnit / kCodeUnit / 4) << a << " " << b;
            }
        }
        EXPECT_LT(found, of_palettes + of_palettes / 100);
    }
}

TEST(SixValues, AreNotFarFromTheOptimum) {
    std::mt19937 random(5);
    std::int64_t optimal = 0, found = 0;
    for (int n = 0; n < 20; ++n) {
        const auto low = static_cast<int>(random() % 100), high = 120 + static_cast<int>(random() % 130);
        const BlockTexels texels = texels_of(low, high, 255, true, random);
        optimal += reference::least_bc4_error(texels, kBc4Unorm, 255);
        found += bc4_error(texels, kBc4Unorm, with_six_values(texels, kBc4Unorm, {255, 0}));
    }
    EXPECT_LE(found, optimal + optimal / 50);
}

}  // namespace
}  // namespace tex
