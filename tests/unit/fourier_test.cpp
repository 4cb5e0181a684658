// SPDX-License-Identifier: Apache-2.0

#include "surface/fourier.h"

#include <cmath>
#include <complex>
#include <vector>

#include <gtest/gtest.h>

#include "surface/axis_transform.h"
#include "unit/fields.h"
#include "unit/targets.h"

namespace tex {
namespace {

constexpr double kTurn = 6.283185307179586477;
// Every radix, their products, powers, and primes, which go through a chirp.
constexpr int kLengths[] = {1,  2,  3,  4,  5,  6,  7,  8,  9,   11,  12,  13, 15,
                            16, 20, 25, 30, 37, 60, 64, 97, 120, 125, 251, 256};

Groups noise_of(int length, int buffer_length) {
    Groups data = groups_of(buffer_length);
    for (int i = 0; i < length; ++i) {
        for (int lane = 0; lane < kGroup; ++lane) data.row(i)[lane] = static_cast<float>(fields::noise(lane, i) - 0.5);
    }
    return data;
}

double value(const Groups& data, int i, int lane) { return static_cast<double>(data.at(lane, i)); }

// The largest error of any coefficient; that of rounding grows with the root of the length.
double fourier_error(int length) {
    const Fourier fourier(length);
    const Groups before = noise_of(length, fourier.buffer_length());
    Groups data = before.clone();
    Groups scratch = groups_of(fourier.buffer_length());
    fourier.run(data, scratch);
    double largest = 0.0;
    for (int lane = 0; lane < kGroup / 2; ++lane) {
        for (int k = 0; k < length; ++k) {
            std::complex<double> sum;
            for (int i = 0; i < length; ++i) {
                const std::complex<double> x(value(before, i, lane), value(before, i, lane + kGroup / 2));
                sum += x * std::polar(1.0, -kTurn * ((i * k) % length) / length);
            }
            const std::complex<double> is(value(data, k, lane), value(data, k, lane + kGroup / 2));
            largest = std::max(largest, std::abs(is - sum));
        }
    }
    return largest;
}

TEST(Fourier, EveryLengthAgreesWithTheSumInDouble) {
    for (const int length : kLengths) EXPECT_LT(fourier_error(length), 2e-6 * std::sqrt(length)) << length;
}

TEST(Fourier, SameBytesOnEveryTarget) {
    for (const int length : {30, 64, 97}) {
        std::vector<std::uint64_t> hashes;
        on_every_target([&] {
            const Fourier fourier(length);
            Groups data = noise_of(length, fourier.buffer_length());
            Groups scratch = groups_of(fourier.buffer_length());
            fourier.run(data, scratch);
            Groups result(Extent{kGroup, length});
            for (int k = 0; k < length; ++k) std::copy_n(data.row(k), kGroup, result.row(k));
            hashes.push_back(fields::hash_of(result));
        });
        for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes.front()) << length;
    }
}

// Hartley: sum of x (cos + sin); cosine: sum of x cos(w (i + 1/2)).
double axis_error(int length, bool is_mirrored) {
    const AxisTransform axis(length, is_mirrored);
    const Groups before = noise_of(length, length);
    Groups data = groups_of(axis.buffer_length());
    Groups scratch = groups_of(axis.buffer_length());
    for (int i = 0; i < length; ++i)
        std::copy_n(before.row(axis.order()[static_cast<std::size_t>(i)]), kGroup, data.row(i));
    axis.forward(data, scratch);
    double largest = 0.0;
    for (int lane = 0; lane < kGroup; ++lane) {
        for (int k = 0; k < length; ++k) {
            double sum = 0.0;
            for (int i = 0; i < length; ++i) {
                const double w = axis.frequency(k);
                const double basis = is_mirrored ? std::cos(w * (i + 0.5)) : std::cos(w * i) + std::sin(w * i);
                sum += value(before, i, lane) * basis;
            }
            largest = std::max(largest, std::abs(value(data, k, lane) - sum));
        }
    }
    axis.inverse(data, scratch);
    const int exchange = axis.swaps_halves() ? kGroup / 2 : 0;
    for (int i = 0; i < length; ++i) {
        const int texel = axis.order()[static_cast<std::size_t>(i)];
        for (int lane = 0; lane < kGroup; ++lane)
            largest =
                std::max(largest, std::abs(value(data, i, lane ^ exchange) / length - value(before, texel, lane)));
    }
    return largest;
}

TEST(Fourier, AxisTransformsAgreeWithTheirSumsAndInvert) {
    for (const int length : kLengths) {
        EXPECT_LT(axis_error(length, false), 3e-6 * std::sqrt(length)) << length;
        EXPECT_LT(axis_error(length, true), 3e-6 * std::sqrt(length)) << length;
    }
}

}  // namespace
}  // namespace tex
