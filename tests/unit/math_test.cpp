// SPDX-License-Identifier: Apache-2.0

#include "rows/math.h"

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace {

using tex::math::kPi;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The largest error of `ours` compared with `truth`, in units in the last place of the double next to the truth.
double largest_error(const std::function<double(double)>& ours, const std::function<long double(long double)>& truth,
                     double low, double high, int count = 200000) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> distribution(low, high);
    double largest = 0.0;
    for (int k = 0; k < count; ++k) {
        const double x = distribution(random);
        const long double exact = truth(static_cast<long double>(x));
        const double rounded = std::abs(static_cast<double>(exact));
        const double ulp = std::nextafter(rounded, kInfinity) - rounded;
        const auto error = static_cast<double>(std::abs(static_cast<long double>(ours(x)) - exact));
        largest = std::max(largest, error / ulp);
    }
    return largest;
}

long double exp_l(long double x) { return std::exp(x); }
long double log_l(long double x) { return std::log(x); }
long double sin_l(long double x) { return std::sin(x); }
long double cos_l(long double x) { return std::cos(x); }
long double atan_l(long double x) { return std::atan(x); }

TEST(Math, ExpIsWithinOneUlp) {
    EXPECT_LT(largest_error(tex::math::exp, exp_l, -700.0, 700.0), 1.0);
    EXPECT_LT(largest_error(tex::math::exp, exp_l, -1.0, 1.0), 1.0);
}

TEST(Math, LogIsWithinOneUlp) {
    EXPECT_LT(largest_error(tex::math::log, log_l, 0.5, 2.0), 1.0);
    EXPECT_LT(largest_error(tex::math::log, log_l, 0.99, 1.01), 1.0);
    EXPECT_LT(largest_error(tex::math::log, log_l, 0.0, 1e-300), 1.0);
    EXPECT_LT(largest_error(tex::math::log, log_l, 0.0, 1e300), 1.0);
}

TEST(Math, SinAndCosAreWithinOneAndAHalfUlpAndLargeAnglesWithinTwoAndAHalf) {
    for (const double range : {1.0, 10.0, 1e3, 1e6}) {
        const double bound = range > 1e3 ? 2.5 : 1.5;
        EXPECT_LT(largest_error(tex::math::sin, sin_l, -range, range), bound) << range;
        EXPECT_LT(largest_error(tex::math::cos, cos_l, -range, range), bound) << range;
    }
    EXPECT_TRUE(std::isnan(tex::math::sin(kInfinity)));
    EXPECT_LE(std::abs(tex::math::sin(9.9e8)), 1.0);
}

TEST(Math, AtanIsWithinOneAndAHalfUlp) {
    for (const double range : {0.01, 1.0, 2.0, 100.0, 1e10}) {
        EXPECT_LT(largest_error(tex::math::atan, atan_l, -range, range), 1.5) << range;
    }
    EXPECT_EQ(tex::math::atan(kInfinity), kPi / 2);
    EXPECT_EQ(tex::math::atan(-kInfinity), -kPi / 2);
    EXPECT_EQ(tex::math::atan(1.0), kPi / 4);
}

TEST(Math, PowErrorGrowsWithTheExponentOnly) {
    for (const double y : {0.5, 1.0 / 2.4, 2.4, 2.2, 10.0, -3.0}) {
        const double bound = 2.0 + 3.0 * std::abs(y * std::log(1e-4));
        EXPECT_LT(largest_error([y](double x) { return tex::math::pow(x, y); },
                                [y](long double x) { return std::pow(x, static_cast<long double>(y)); }, 1e-4, 1.0),
                  bound)
            << y;
    }
}

TEST(Math, SpecialValuesAreThoseOfTheStandard) {
    EXPECT_EQ(tex::math::exp(0.0), 1.0);
    EXPECT_EQ(tex::math::exp(-kInfinity), 0.0);
    EXPECT_EQ(tex::math::exp(kInfinity), kInfinity);
    EXPECT_EQ(tex::math::exp(800.0), kInfinity);
    EXPECT_EQ(tex::math::exp(-800.0), 0.0);
    EXPECT_GT(tex::math::exp(-745.0), 0.0);
    EXPECT_LT(tex::math::exp(709.7), kInfinity);
    EXPECT_EQ(tex::math::log(1.0), 0.0);
    EXPECT_EQ(tex::math::log(0.0), -kInfinity);
    EXPECT_EQ(tex::math::log(kInfinity), kInfinity);
    EXPECT_TRUE(std::isnan(tex::math::log(-1.0)));
    EXPECT_EQ(tex::math::pow(0.0, 2.4), 0.0);
    EXPECT_EQ(tex::math::pow(0.0, 0.0), 1.0);
    EXPECT_EQ(tex::math::pow(1.0, 123.0), 1.0);
    EXPECT_TRUE(std::isnan(tex::math::pow(-1.0, 0.5)));
    EXPECT_TRUE(std::signbit(tex::math::sin(-0.0)));
    EXPECT_TRUE(std::signbit(tex::math::atan(-0.0)));
    for (const auto function : {tex::math::exp, tex::math::log, tex::math::sin, tex::math::cos, tex::math::atan}) {
        EXPECT_TRUE(std::isnan(function(std::numeric_limits<double>::quiet_NaN())));
    }
}

TEST(Math, SincIsOneAtZeroAndZeroAtTheOtherIntegers) {
    EXPECT_EQ(tex::math::sinc(0.0), 1.0);
    for (int k = 1; k < 10; ++k) {
        EXPECT_EQ(tex::math::sinc(k), 0.0);
        EXPECT_EQ(tex::math::sinc(-k), 0.0);
    }
    for (const double x : {0.25, 0.5, 0.9, 1.3, 2.7, -1.5}) {
        EXPECT_NEAR(tex::math::sinc(x), std::sin(kPi * x) / (kPi * x), 1e-15);
    }
}

}  // namespace
