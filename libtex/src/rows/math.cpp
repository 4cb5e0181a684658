// SPDX-License-Identifier: Apache-2.0

#include "rows/math.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace tex::inline v1::math {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// ln 2 and pi/2 in parts. The first parts end in enough zero bits for their products with the integers that occur here
// to be exact.
constexpr double kLn2High = 0x1.62e42fee00000p-1, kLn2Low = 0x1.a39ef35793c76p-33;
constexpr double kHalfPiHigh = 0x1.921fb54400000p+0, kHalfPiMiddle = 0x1.0b4611a600000p-34,
                 kHalfPiLow = 0x1.3198a2e037073p-69;
constexpr double kInverseLn2 = 0x1.71547652b82fep+0, kInverseHalfPi = 0x1.45f306dc9c883p-1;

// c[0] + x (c[1] + x (c[2] + ...))
template <std::size_t N>
double polynomial(const std::array<double, N>& c, double x) {
    double sum = c[N - 1];
    for (std::size_t k = N - 1; k-- > 0;) sum = c[k] + x * sum;
    return sum;
}

// 1/first!, 1/(first + step)!, ... with the signs of `alternate` (1 or -1) to the k-th power.
template <std::size_t N>
constexpr std::array<double, N> inverse_factorials(int first, int step, int alternate) {
    std::array<double, N> c{};
    double factorial = 1.0;  // exact up to 22!
    int n = 1;
    double sign = 1.0;
    for (std::size_t k = 0; k < N; ++k) {
        for (; n <= first + step * static_cast<int>(k); ++n) factorial *= n;
        c[k] = sign / factorial;
        sign *= alternate;
    }
    return c;
}

// 1/first, 1/(first + 2), ... with alternating or equal signs, as above.
template <std::size_t N>
constexpr std::array<double, N> inverse_odds(int first, int alternate) {
    std::array<double, N> c{};
    double sign = 1.0;
    for (std::size_t k = 0; k < N; ++k) {
        c[k] = sign / (first + 2 * static_cast<int>(k));
        sign *= alternate;
    }
    return c;
}

double power_of_two(int exponent) {  // -1022 to 1023
    return std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52);
}

// Sine and cosine for |r| <= pi/4 (a little more does no harm).
double sin_near_zero(double r) {
    constexpr auto kSeries = inverse_factorials<8>(3, 2, -1);
    const double square = r * r;
    return r - r * (square * polynomial(kSeries, square));
}

double cos_near_zero(double r) {
    constexpr auto kSeries = inverse_factorials<8>(4, 2, -1);
    const double square = r * r;
    // 1 - square/2 is rounded; the rounding error is added to the small terms.
    const double half = 0.5 * square;
    const double head = 1.0 - half;
    return head + (((1.0 - head) - half) + square * square * polynomial(kSeries, square));
}

// x = quadrant * pi/2 + remainder.
struct Quadrant {
    int index;  // 0 to 3
    double remainder;
};

Quadrant reduce_angle(double x) {
    const double n = std::floor(x * kInverseHalfPi + 0.5);
    const double remainder = ((x - n * kHalfPiHigh) - n * kHalfPiMiddle) - n * kHalfPiLow;
    return {static_cast<int>(static_cast<std::int64_t>(n) & 3), remainder};
}

bool is_angle(double x) { return x >= -1e9 && x <= 1e9; }

}  // namespace

double exp(double x) {
    if (x != x) return x;
    if (x > 709.79) return kInfinity;
    if (x < -745.2) return 0.0;
    // x = n ln 2 + r, |r| <= ln(2) / 2
    const double n = std::floor(x * kInverseLn2 + 0.5);
    const double r = (x - n * kLn2High) - n * kLn2Low;
    constexpr auto kSeries = inverse_factorials<13>(2, 1, 1);
    const double mantissa = 1.0 + (r + r * r * polynomial(kSeries, r));
    // In two steps, because 2^n alone may be out of the range of a double even if the result is not.
    const int exponent = static_cast<int>(n);
    const int half = exponent / 2;
    return mantissa * power_of_two(half) * power_of_two(exponent - half);
}

double log(double x) {
    if (x != x || x < 0.0) return kNan;
    if (x == 0.0) return -kInfinity;
    if (x == kInfinity) return x;
    double exponent = 0.0;
    if (x < std::numeric_limits<double>::min()) {  // subnormal
        x *= 0x1p54;
        exponent = -54.0;
    }
    // x = 2^e (1 + f), sqrt(1/2) < 1 + f <= sqrt(2)
    const auto bits = std::bit_cast<std::uint64_t>(x);
    exponent += static_cast<double>(static_cast<int>(bits >> 52) - 1023);
    double mantissa = std::bit_cast<double>((bits & 0x000fffffffffffffu) | 0x3ff0000000000000u);
    if (mantissa > 0x1.6a09e667f3bcdp+0) {
        mantissa *= 0.5;
        exponent += 1.0;
    }
    const double f = mantissa - 1.0;
    // log(1 + f) = 2 artanh(s), s = f / (2 + f); written so that f itself, which is exact, is the leading
    // term: 2 s = f - s f = f - f^2/2 + s f^2/2
    const double s = f / (2.0 + f);
    const double square = s * s;
    constexpr auto kSeries = inverse_odds<11>(3, 1);
    const double tail = 2.0 * square * polynomial(kSeries, square);
    const double half = 0.5 * f * f;
    return exponent * kLn2High - ((half - (s * (half + tail) + exponent * kLn2Low)) - f);
}

double sin(double x) {
    if (!is_angle(x)) return kNan;
    if (x == 0.0) return x;
    const Quadrant q = reduce_angle(x);
    const double value = (q.index & 1) != 0 ? cos_near_zero(q.remainder) : sin_near_zero(q.remainder);
    return (q.index & 2) != 0 ? -value : value;
}

double cos(double x) {
    if (!is_angle(x)) return kNan;
    const Quadrant q = reduce_angle(x);
    const double value = (q.index & 1) != 0 ? sin_near_zero(q.remainder) : cos_near_zero(q.remainder);
    return ((q.index + 1) & 2) != 0 ? -value : value;
}

double atan(double x) {
    if (x != x || x == 0.0) return x;
    // atan(k / 8) as a double, and the remainder of that double, k = 0 to 8
    constexpr double kHigh[9] = {0.0,
                                 0x1.fd5ba9aac2f6ep-4,
                                 0x1.f5b75f92c80ddp-3,
                                 0x1.6f61941e4def1p-2,
                                 0x1.dac670561bb4fp-2,
                                 0x1.1e00babdefeb4p-1,
                                 0x1.4978fa3269ee1p-1,
                                 0x1.700a7c5784634p-1,
                                 0x1.921fb54442d18p-1};
    constexpr double kLow[9] = {0.0,
                                -0x1.cd37686760c17p-59,
                                0x1.8ab6e3cf7afbdp-57,
                                -0x1.c63aae6f6e918p-56,
                                0x1.a2b7f222f65e2p-56,
                                -0x1.928df287a668fp-58,
                                0x1.2419a87f2a458p-56,
                                -0x1.8c34d25aadef6p-56,
                                0x1.1a62633145c07p-55};
    constexpr double kHalfPi = 0x1.921fb54442d18p+0, kHalfPiRest = 0x1.1a62633145c07p-54;
    constexpr auto kSeries = inverse_odds<7>(3, -1);
    const double magnitude = x < 0.0 ? -x : x;
    // atan(a) = atan(c) + atan((a - c) / (1 + a c)) with c = k/8 next to a; atan(a) = pi/2 - atan(1/a)
    // beyond 1, where (1/a - c) / (1 + c/a) = (1 - a c) / (a + c) needs no rounded 1/a.
    const bool steep = magnitude > 1.0;
    const double small = steep ? 1.0 / magnitude : magnitude;
    const int k = static_cast<int>(small * 8.0 + 0.5);
    const double c = k / 8.0;
    const double t = magnitude == kInfinity ? 0.0
                     : steep                ? (1.0 - magnitude * c) / (magnitude + c)
                                            : (magnitude - c) / (1.0 + magnitude * c);
    const double square = t * t;
    const double correction = kLow[k] - t * (square * polynomial(kSeries, square));
    const double angle = steep ? (kHalfPi - kHigh[k]) - (t - (kHalfPiRest - correction)) : kHigh[k] + (t + correction);
    return x < 0.0 ? -angle : angle;
}

double pow(double x, double y) {
    if (y == 0.0 || x == 1.0) return 1.0;
    return exp(y * log(x));
}

double sinc(double x) {
    if (x == 0.0) return 1.0;
    // sin(pi x) = (-1)^n sin(pi (x - n)): the subtraction is exact, and so are the zeros.
    const double n = std::floor(x + 0.5);
    const double value = sin(kPi * (x - n)) / (kPi * x);
    return std::floor(n * 0.5) * 2.0 == n ? value : -value;
}

}  // namespace tex::inline v1::math
