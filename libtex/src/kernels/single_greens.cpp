// SPDX-License-Identifier: Apache-2.0

#include "kernels/single_greens.h"

#include <algorithm>

#include "blocks/bc1.h"

namespace tex::inline v1 {
namespace {

constexpr int kThirds = kMostThirds + 1;

struct Table {
    SingleGreen below[kThirds];
    SingleGreen above[kThirds];

    explicit Table(int most) {
        SingleGreen exact[kThirds];
        std::fill(exact, exact + kThirds, SingleGreen{-1, 0, 64});
        for (int lower = 63; lower >= 0; --lower) {
            for (int distance = 0; distance <= std::min(most, 63 - lower); ++distance) {
                for (int k = 0; k < 4; ++k) {
                    const int third = (3 - k) * widen_green(lower) + k * widen_green(lower + distance);
                    if (distance < exact[third].distance) exact[third] = {third, lower, distance};
                }
            }
        }
        // 0 and 765 always exist, so both loops start with an entry.
        for (int t = 0; t < kThirds; ++t) below[t] = exact[t].third >= 0 ? exact[t] : below[t - 1];
        for (int t = kThirds - 1; t >= 0; --t) above[t] = exact[t].third >= 0 ? exact[t] : above[t + 1];
    }
};

const Table& all() {
    static const Table greens(63);
    return greens;
}

struct Packed {
    std::int32_t below[kThirds];
    std::int32_t above[kThirds];

    Packed() {
        const Table near(kMaxSingleDistance);
        const auto packed = [](const SingleGreen& green) {
            return green.third << 16 | green.lower << 8 | green.distance;
        };
        std::transform(near.below, near.below + kThirds, below, packed);
        std::transform(near.above, near.above + kThirds, above, packed);
    }
};
const Packed& near() {
    static const Packed greens;
    return greens;
}

}  // namespace

const SingleGreen& single_green_below(int third) { return all().below[third]; }
const SingleGreen& single_green_above(int third) { return all().above[third]; }

const std::int32_t* single_greens_below() { return near().below; }
const std::int32_t* single_greens_above() { return near().above; }

}  // namespace tex::inline v1
