// SPDX-License-Identifier: Apache-2.0

#include "kernels/png_filter.h"

#include <cstdint>
#include <cstdlib>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "unit/targets.h"

namespace tex {
namespace {

using Row = std::vector<std::uint8_t>;

constexpr std::size_t kZeros = 8;

int at(const Row& row, std::size_t i) { return row[kZeros + i]; }

// The predictor as the specification states it.
int paeth(int a, int b, int c) {
    const int p = a + b - c;
    const int pa = std::abs(p - a), pb = std::abs(p - b), pc = std::abs(p - c);
    if (pa <= pb && pa <= pc) return a;
    return pb <= pc ? b : c;
}

Row filtered(const Row& row, const Row& above, std::size_t step, std::uint8_t filter) {
    Row out = {filter};
    for (std::size_t i = 0; i + kZeros < row.size(); ++i) {
        const int a = i < step ? 0 : at(row, i - step);
        const int b = at(above, i);
        const int c = i < step ? 0 : at(above, i - step);
        const int predicted[] = {0, a, b, (a + b) / 2, paeth(a, b, c)};
        out.push_back(static_cast<std::uint8_t>(at(row, i) - predicted[filter]));
    }
    return out;
}

long magnitude(const Row& filtered_row) {
    long sum = 0;
    for (std::size_t i = 1; i < filtered_row.size(); ++i) {
        sum += std::abs(static_cast<int>(static_cast<std::int8_t>(filtered_row[i])));
    }
    return sum;
}

Row expected(const Row& row, const Row& above, std::size_t step) {
    Row best = filtered(row, above, step, 0);
    for (std::uint8_t filter = 1; filter < 5; ++filter) {
        Row other = filtered(row, above, step, filter);
        if (magnitude(other) < magnitude(best)) best = other;
    }
    return best;
}

// Rows of every kind for which another filter is best.
Row random_row(std::mt19937& random, std::size_t count, const Row* above) {
    Row row(kZeros + count);
    const auto kind = static_cast<unsigned>(random() % 4);
    for (std::size_t i = kZeros; i < row.size(); ++i) {
        const auto noise = static_cast<unsigned>(random() % 3);
        const unsigned left = row[i - 1];
        const unsigned up = above != nullptr ? (*above)[i] : 0;
        const unsigned base = kind == 0   ? static_cast<unsigned>(random())
                              : kind == 1 ? left
                              : kind == 2 ? up
                                          : (left + up) / 2;
        row[i] = static_cast<std::uint8_t>(base + noise);
    }
    return row;
}

TEST(PngFilter, IsThatOfTheHeuristicOnEveryTarget) {
    bool chosen[5] = {};
    on_every_target([&] {
        std::mt19937 random(1);
        for (int k = 0; k < 600; ++k) {
            const std::size_t step = std::size_t{1} << random() % 4;
            const std::size_t count = 1 + random() % 300;
            const Row above = k % 10 == 0 ? Row(kZeros + count) : random_row(random, count, nullptr);
            const Row row = random_row(random, count, &above);
            Row out(1 + count);
            filter_png_row(row.data() + kZeros, above.data() + kZeros, count, step, out.data());
            ASSERT_EQ(out, expected(row, above, step)) << count << " bytes, texels of " << step;
            chosen[out[0]] = true;
        }
    });
    for (const bool once : chosen) EXPECT_TRUE(once);
}

TEST(PngFilter, PaethIsThatOfTheSpecificationForAllNeighbours) {
    // Paeth is best if the row is what it predicts. Texels of one byte alternate between the byte to be predicted from
    // and its prediction, so each pair of texels is one case.
    on_every_target([] {
        for (int b = 0; b < 256; b += 5) {
            for (int c = 0; c < 256; c += 3) {
                Row above(kZeros), row(kZeros);
                for (int a = 0; a < 256; ++a) {
                    for (const int v : {c, b}) above.push_back(static_cast<std::uint8_t>(v));
                    for (const int v : {a, paeth(a, b, c)}) row.push_back(static_cast<std::uint8_t>(v));
                }
                Row out(1 + row.size() - kZeros);
                filter_png_row(row.data() + kZeros, above.data() + kZeros, out.size() - 1, 1, out.data());
                ASSERT_EQ(out, expected(row, above, 1)) << b << " " << c;
            }
        }
    });
}

TEST(PngFilter, SwapsTheBytesOfSamplesOnEveryTarget) {
    on_every_target([] {
        for (std::size_t count = 0; count < 150; ++count) {
            Row samples(2 * count + 1), swapped(2 * count + 1);
            for (std::size_t i = 0; i < 2 * count; ++i) samples[i] = static_cast<std::uint8_t>(i * 7);
            for (std::size_t i = 0; i < 2 * count; ++i) swapped[i] = samples[i ^ 1u];
            swap_sample_bytes(samples.data(), count);
            ASSERT_EQ(samples, swapped) << count;
        }
    });
}

}  // namespace
}  // namespace tex
