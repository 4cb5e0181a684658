// SPDX-License-Identifier: Apache-2.0

#include "kernels/uastc_xy_hints.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "blocks/eac.h"

namespace tex::inline v1 {
namespace {

constexpr int kGreyModifiers[8][2] = {{2, 8}, {5, 17}, {9, 29}, {13, 42}, {18, 60}, {24, 80}, {33, 106}, {47, 183}};

int squared(int n) { return n * n; }

// What transcoders make of the mean of a half of eight texels: a base of 4 or 5 bits.
int base_of(int sum, bool diff) {
    const int limit = diff ? 31 : 15, base = (sum * limit + 1020) / 2040;
    return base == 0 ? 1 : base == limit ? limit - 1 : base;  // "unmoved" moves the extremes
}

// The least squared error of a half around a base, over all tables.
int best_table(const int values[8], int base, std::uint8_t& table) {
    int least = 1 << 30;
    for (std::uint8_t t = 0; t < 8; ++t) {
        const int small = kGreyModifiers[t][0], large = kGreyModifiers[t][1];
        const int steps[4] = {std::max(0, base - large), std::max(0, base - small), std::min(255, base + small),
                              std::min(255, base + large)};
        int sum = 0;
        for (int k = 0; k < 8; ++k) {
            const int value = values[k];
            const int low = std::min(squared(value - steps[0]), squared(value - steps[1]));
            sum += std::min(low, std::min(squared(value - steps[2]), squared(value - steps[3])));
        }
        if (sum >= least) continue;
        least = sum;
        table = t;
    }
    return least;
}

void find_grey_hints(const std::uint8_t grey[16], UastcHints& hints) {
    int least = 1 << 30;
    for (const bool flip : {false, true}) {
        int values[2][8], count[2] = {}, sums[2] = {};
        for (int k = 0; k < 16; ++k) {
            const int half = (flip ? k / 4 : k % 4) / 2;
            values[half][count[half]++] = grey[k];
            sums[half] += grey[k];
        }
        for (const bool diff : {false, true}) {
            int base[2] = {base_of(sums[0], diff), base_of(sums[1], diff)}, error = 0;
            if (diff) base[1] = base[0] + std::clamp(base[1] - base[0], -4, 3);
            std::uint8_t tables[2] = {};
            for (int half = 0; half < 2; ++half) {
                const int wide = diff ? base[half] << 3 | base[half] >> 2 : 17 * base[half];
                error += best_table(values[half], wide, tables[half]);
            }
            if (error >= least) continue;
            least = error;
            hints.flip = flip;
            hints.diff = diff;
            std::copy_n(tables, 2, hints.table);
        }
    }
}

int eac_error(const std::uint8_t alpha[16], const int modifiers[8], int center, int multiplier, int least) {
    int values[8], sum = 0;
    for (int s = 0; s < 8; ++s) values[s] = std::clamp(center + modifiers[s] * multiplier, 0, 255);
    for (int k = 0; k < 16 && sum < least; ++k) {
        int nearest = 255;
        for (const int value : values) nearest = std::min(nearest, std::abs(value - alpha[k]));
        sum += squared(nearest);
    }
    return sum;
}

// The base is what transcoders make of the least and the greatest alpha.
void find_alpha_hints(Effort effort, const std::uint8_t alpha[16], UastcHints& hints) {
    const auto [low, high] = std::minmax_element(alpha, alpha + 16);
    if (*low == *high) return;
    const auto begin = static_cast<float>(*low), range = static_cast<float>(*high - *low);
    int least = 1 << 30;
    for (int table = 0; table < kEacTables; ++table) {
        const int* const modifiers = kEacModifiers[table];
        const auto reach = static_cast<float>(modifiers[7] - modifiers[3]);
        const int center = static_cast<int>(std::round(begin + range * (static_cast<float>(-modifiers[3]) / reach)));
        const int usual = static_cast<int>(std::lround(range / reach));
        const int more = effort == Effort::fast ? 0 : effort == Effort::normal ? 1 : 15;
        for (int m = std::max(1, usual - more); m <= std::min(15, std::max(1, usual + more)); ++m) {
            const int error = eac_error(alpha, modifiers, center, m, least);
            if (error >= least) continue;
            least = error;
            hints.eac = static_cast<std::uint8_t>(table | m << 4);
        }
    }
}

}  // namespace

void find_uastc_xy_hints(Effort effort, const std::uint8_t grey[16], const std::uint8_t alpha[16], UastcHints& hints) {
    find_grey_hints(grey, hints);
    find_alpha_hints(effort, alpha, hints);
}

UastcHints grey_hints(std::uint8_t grey) {
    UastcHints hints;
    int least = 1 << 30;
    for (int n = 0; n < 64; ++n) {
        const bool diff = n >= 32;
        const int table = n / 4 % 8, selector = n % 4;
        const int size = kGreyModifiers[table][selector == 0 || selector == 3 ? 1 : 0];
        const int modifier = selector < 2 ? -size : size, limit = diff ? 31 : 15;
        const int base = std::clamp(((grey - modifier) * limit + 127) / 255, 0, limit);
        const int wide = diff ? base << 3 | base >> 2 : 17 * base;
        const int error = std::abs(std::clamp(wide + modifier, 0, 255) - grey);
        if (error >= least) continue;
        least = error;
        hints.diff = diff;
        hints.table[0] = static_cast<std::uint8_t>(table);
        hints.selector = static_cast<std::uint8_t>(selector);
        std::fill_n(hints.base, 3, static_cast<std::uint8_t>(base));
    }
    return hints;
}

}  // namespace tex::inline v1
