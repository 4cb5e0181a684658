// SPDX-License-Identifier: Apache-2.0
// tone_text.h: what a change of levels was, in words.

#pragma once

#include <string>
#include <string_view>

#include <tex/check.h>

namespace tex::inline v1 {

// Levels that only add: brightness, without a contrast.
[[nodiscard]] bool is_shift(const ToneCurve& curve);

// A subject and its verb: "gamma 0.80 of R is", "the levels from 10 % to 90 % are". `of` follows the noun.
[[nodiscard]] std::string curve_text(const ToneCurve& curve, std::string_view of = {});

}  // namespace tex::inline v1
