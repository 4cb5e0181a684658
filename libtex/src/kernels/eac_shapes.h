// SPDX-License-Identifier: Apache-2.0
// eac_shapes.h: EAC's tables of modifiers in the form that searches use.

#pragma once

#include <array>

#include "blocks/eac.h"

namespace tex::inline v1 {

// A table in ascending order: entries k and k + 1 are gaps[k] apart, and the threshold between them lies at sums[k]
// / 2.
struct EacShape {
    int lowest, greatest;  // modifiers
    int sums[7];
    float gaps[7];
    float halves[4];  // distances of the upper four from the middle of the palette, -1/2
};

constexpr EacShape eac_shape(int table) {
    constexpr int kAscending[8] = {3, 2, 1, 0, 4, 5, 6, 7};
    const auto modifier = [&](int k) { return kEacModifiers[table][kAscending[k]]; };
    EacShape shape{};
    shape.lowest = modifier(0);
    shape.greatest = modifier(7);
    for (int k = 0; k < 7; ++k) {
        shape.sums[k] = modifier(k) + modifier(k + 1);
        shape.gaps[k] = static_cast<float>(modifier(k + 1) - modifier(k));
    }
    for (int k = 0; k < 4; ++k) shape.halves[k] = static_cast<float>(modifier(4 + k)) + 0.5f;
    return shape;
}

inline constexpr std::array<EacShape, kEacTables> kEacShapes = [] {
    std::array<EacShape, kEacTables> shapes{};
    for (int table = 0; table < kEacTables; ++table) shapes[static_cast<std::size_t>(table)] = eac_shape(table);
    return shapes;
}();

// Which neighbouring thresholds fit into a range: of all n of a table that are at most `length` apart (in sums; a
// single threshold: whose gap is at most `length`), the least sum of a last one and the greatest sum of a first one. If
// none fit, last > first + kLongestWindow.
inline constexpr int kLongestWindow = 64;
struct EacWindow {
    int last, first;
    [[nodiscard]] bool empty() const { return last > first + kLongestWindow; }
};

// `count` is from 1 to 7, length from 0 on.
[[nodiscard]] const EacWindow& eac_window(int table, int count, int length);

}  // namespace tex::inline v1
