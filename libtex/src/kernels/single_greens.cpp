// SPDX-License-Identifier: Apache-2.0

#include "kernels/single_greens.h"

#include <algorithm>
#include <cmath>

#include "blocks/bc1.h"

namespace tex {
namespace {

constexpr int kThirds = 3 * 255 + 1;

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
        // 0 and 765 are there, so both runs start with an entry.
        for (int t = 0; t < kThirds; ++t) below[t] = exact[t].third >= 0 ? exact[t] : below[t - 1];
        for (int t = kThirds - 1; t >= 0; --t) above[t] = exact[t].third >= 0 ? exact[t] : above[t + 1];
    }
};

// With all endpoints, and with near ones.
const Table& all() {
    static const Table greens(63);
    return greens;
}
const Table& near() {
    static const Table greens(kMaxSingleDistance);
    return greens;
}

}  // namespace

const SingleGreen& single_green_below(int third) { return all().below[third]; }
const SingleGreen& single_green_above(int third) { return all().above[third]; }

SingleGreen nearest_single_green(float value) {
    const int third = std::clamp(static_cast<int>(3.0f * value), 0, kThirds - 1);
    const SingleGreen& below = near().below[third];
    const SingleGreen& above = near().above[std::min(third + 1, kThirds - 1)];
    const float down = std::fabs(3.0f * value - static_cast<float>(below.third));
    const float up = std::fabs(static_cast<float>(above.third) - 3.0f * value);
    return down < up ? below : above;
}

}  // namespace tex
