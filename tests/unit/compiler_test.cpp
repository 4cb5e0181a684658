// SPDX-License-Identifier: Apache-2.0
// What libtex takes for granted of the compiler and its flags.

#include <cmath>

#include <gtest/gtest.h>

namespace tex {
namespace {

// Two sums, rounded to float, as doubles again.
[[gnu::noinline]] void round_sums(const double* weights, const double* in, double* out, int count) {
    for (int k = 0; k < count; ++k) {
        const auto x = static_cast<float>(weights[0] * in[2 * k] + weights[1] * in[2 * k + 1]);
        const auto y = static_cast<float>(weights[2] * in[2 * k] + weights[3] * in[2 * k + 1]);
        out[2 * k] = static_cast<double>(x);
        out[2 * k + 1] = static_cast<double>(y);
    }
}

// GCC 12 leaves the rounding out where it joins statements to vectors (findings/gcc-slp-float.sh).
TEST(Compiler, RoundsDoublesToFloat) {
    constexpr int kCount = 64;
    double weights[4] = {0.1, 0.7, 1.3, 0.3}, in[2 * kCount], out[2 * kCount] = {};
    for (int k = 0; k < 2 * kCount; ++k) in[k] = std::sqrt(k + 2.0);
    round_sums(weights, in, out, kCount);
    for (const double value : out) EXPECT_EQ(value, static_cast<double>(static_cast<float>(value)));
}

}  // namespace
}  // namespace tex
