// SPDX-License-Identifier: Apache-2.0
// exhaustive_search.h: the endpoints with the least squared error of one channel of a block, found by trying all pairs.
//
// Pairs whose lower endpoint is within `reach` codes of the least value, and whose greater one is within `reach` codes
// of the greatest, are tried: all of them, if `reach` is the greatest code.

#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <utility>

#include "blocks/bc1.h"
#include "blocks/bc4.h"

namespace tex::reference {

// The values of a palette times `unit`; texels are multiplied by `scale` before they are compared.
template <std::size_t N>
std::int64_t error_up_to(std::int64_t limit, const BlockTexels& texels, const std::array<std::int64_t, N>& palette,
                         std::int64_t scale) {
    std::int64_t sum = 0;
    for (int k = 0; k < 16 && sum <= limit; ++k) {
        if ((texels.mask >> k & 1) == 0) continue;
        std::int64_t least = std::numeric_limits<std::int64_t>::max();
        for (const std::int64_t value : palette) {
            const std::int64_t d = texels.values[k] * scale - value;
            least = std::min(least, d * d);
        }
        sum += least;
    }
    return sum;
}

inline std::pair<std::int32_t, std::int32_t> range_of(const BlockTexels& texels) {
    std::int32_t least = std::numeric_limits<std::int32_t>::max(), greatest = 0;
    for (int k = 0; k < 16; ++k) {
        if ((texels.mask >> k & 1) == 0) continue;
        least = std::min(least, texels.values[k]);
        greatest = std::max(greatest, texels.values[k]);
    }
    return {least, greatest};
}

// The error of the best pair with 8 and with 6 values, in the unit of bc4_error().
inline std::int64_t least_bc4_error(const BlockTexels& texels, Bc4Codes codes, int reach) {
    const auto [least, greatest] = range_of(texels);
    const int low = least / kCodeUnit, high = (greatest + kCodeUnit - 1) / kCodeUnit;
    const std::int64_t seventh = kBc4ErrorUnit / 7, fifth = kBc4ErrorUnit / 5;
    std::int64_t best = std::numeric_limits<std::int64_t>::max();
    for (std::int64_t a = std::max(0, low - reach); a <= std::min(codes.top, low + reach); ++a) {
        for (std::int64_t b = std::max<std::int64_t>(a, high - reach); b <= std::min(codes.top, high + reach); ++b) {
            const std::array<std::int64_t, 8> six{5 * a * fifth,
                                                  (4 * a + b) * fifth,
                                                  (3 * a + 2 * b) * fifth,
                                                  (2 * a + 3 * b) * fifth,
                                                  (a + 4 * b) * fifth,
                                                  5 * b * fifth,
                                                  0,
                                                  codes.top * kBc4ErrorUnit};
            best = std::min(best, error_up_to(best, texels, six, kBc4ErrorUnit / kCodeUnit));
            if (a == b) continue;
            std::array<std::int64_t, 8> eight{};
            for (std::int64_t k = 0; k < 8; ++k) eight[static_cast<std::size_t>(k)] = ((7 - k) * a + k * b) * seventh;
            best = std::min(best, error_up_to(best, texels, eight, kBc4ErrorUnit / kCodeUnit));
        }
    }
    return best;
}

// The error of the best pair of 6-bit greens, in the unit of green_error().
inline std::int64_t least_green_error(const BlockTexels& texels, int reach) {
    const auto [least, greatest] = range_of(texels);
    const int low = std::max(0, least / kCodeUnit * 63 / 255 - 1);
    const int high = std::min(63, greatest / kCodeUnit * 63 / 255 + 1);
    std::int64_t best = std::numeric_limits<std::int64_t>::max();
    for (int a = std::max(0, low - reach); a <= std::min(63, low + reach); ++a) {
        for (int b = std::max(a, high - reach); b <= std::min(63, high + reach); ++b) {
            const std::int64_t first = (a << 2 | a >> 4) * kCodeUnit, second = (b << 2 | b >> 4) * kCodeUnit;
            const std::array<std::int64_t, 4> palette{3 * first, 2 * first + second, first + 2 * second, 3 * second};
            best = std::min(best, error_up_to(best, texels, palette, 3));
        }
    }
    return best;
}

}  // namespace tex::reference
