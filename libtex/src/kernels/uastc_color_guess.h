// SPDX-License-Identifier: Apache-2.0
// uastc_color_guess.h: guesses from moments how well blocks of values fit the modes of several subsets, and those of
// two planes.

#pragma once

#include <cstdint>

#include "kernels/uastc_color_fit.h"

namespace tex::inline v1 {

struct UastcColorGuess {
    float error;
    std::uint8_t mode, pattern, second_channel;
};

// The `most` likeliest patterns of two subsets, and with `three` of three; the likeliest one first. Returns how many
// there are. `guesses` has room for all, kUastcColorGuesses.
inline constexpr int kUastcColorGuesses = 128;
[[nodiscard]] int guess_uastc_colors(const UastcColors& colors, bool three, int most, UastcColorGuess* guesses);

// The three choices of the channel that has the second plane, the likeliest one first.
void guess_uastc_color_planes(const UastcColors& colors, UastcColorGuess guesses[3]);

}  // namespace tex::inline v1
