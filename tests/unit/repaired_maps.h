// SPDX-License-Identifier: Apache-2.0
// repaired_maps.h: a clean map for tests of repairs, and what was done about a damaged one.

#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tex/bake.h>
#include <tex/check.h>
#include <tex/pack.h>
#include <tex/repair.h>

#include "reference/damage.h"

namespace tex::repaired_maps {

using reference::Codes;

// A surface without a preferred direction, y up.
inline NormalMap bumps(float bumpiness = 9.0f) {
    constexpr int side = 384;
    HeightField field{Plane<float>(Extent{side, side}), bumpiness, bumpiness, Wrap::repeat, Wrap::repeat};
    const double turn = 2.0 * 3.14159265358979 / side;
    for (int k = 0; k < side * side; ++k) {
        const double x = turn * (k % side), y = turn * (k / side);
        field.height.at(k % side, k / side) =
            static_cast<float>(0.5 + 0.15 * std::sin(9 * x + 6 * y) + 0.12 * std::sin(15 * x - 12 * y + 1.0) +
                               0.1 * std::sin(6 * x + 21 * y + 2.0) * std::cos(18 * x));
    }
    return *bake(field);
}

inline const Codes& clean() {
    static const Codes kCodes = reference::codes_of(bumps());
    return kCodes;
}

inline Repaired repaired(const Texture& texture, const RepairOptions& options = {}) {
    auto done = repair("map", texture, options);
    EXPECT_TRUE(done) << done.error().message();
    return done ? std::move(*done) : Repaired();
}

inline std::vector<unsigned char> codes_in(const Texture& texture) {
    std::vector<unsigned char> codes;
    for (const std::byte byte : texture.levels.front().bytes) codes.push_back(static_cast<unsigned char>(byte));
    return codes;
}

// The rules of the steps, and what they did.
inline std::string plan_of(const Repaired& done) {
    std::string text;
    for (const RepairStep& step : done.steps)
        text += std::string(text.empty() ? "" : ", ") + std::string(step.rule->id) + " " + text_of(step);
    return text;
}

inline double angle(const Texture& a, const Texture& b) {
    const auto x = unpack(a), y = unpack(b);
    return compare(x->levels.front(), y->levels.front())->error.mean;
}

}  // namespace tex::repaired_maps
