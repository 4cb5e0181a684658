// SPDX-License-Identifier: Apache-2.0

#include "blocks/astc_void.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "blocks/astc_ise.h"

namespace tex::inline v1 {

// A decoder keeps 11 bits of a code, so that codes which differ
// in the others are one value: that of `code`, the one before and the one after are what the nearest can be.
int astc_void_code(float value) {
    const auto code = static_cast<int>(std::clamp(value * 257.0f, 0.0f, 65535.0f));
    // How many codes are one value.
    const auto step_of = [](int of) {
        return 1 << std::max(0, static_cast<int>(std::bit_width(static_cast<unsigned>(of))) - 11);
    };
    const auto first_like = [&](int of) { return of & ~(step_of(of) - 1); };
    const int first = first_like(code);
    int best = code;
    const auto take_nearer = [&](int other) {
        if (std::abs(astc_void_value(other) - value) < std::abs(astc_void_value(best) - value)) best = other;
    };
    if (first > 0) take_nearer(std::max(code - 32, first_like(first - 1)));
    const int after = first + step_of(code);
    if (after <= 0xffff) take_nearer(after);
    if (code < 0xffff && code + 32 >= 0xffff) take_nearer(0xffff);
    return best;
}

void write_astc_void(int x, int y, std::byte* block) {
    const auto low = static_cast<std::uint64_t>(x), high = static_cast<std::uint64_t>(y);
    write_astc_bits({~std::uint64_t{0x203}, low | low << 16 | low << 32 | high << 48}, block);
}

}  // namespace tex::inline v1
