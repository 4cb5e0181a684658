// SPDX-License-Identifier: Apache-2.0

#include "kernels/samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <vector>

#include <half.h>

#include "unit/targets.h"

namespace tex {
namespace {

// Decodes all codes of a type, `gap` samples apart; the bytes between them are noise.
template <class T>
std::vector<float> decoded(SampleKind sample, const std::vector<T>& codes, std::size_t gap) {
    std::vector<T> stored(codes.size() * gap, T(0x5a));
    for (std::size_t k = 0; k < codes.size(); ++k) stored[k * gap] = codes[k];
    std::vector<float> values(codes.size() + 1, 7.0f);
    decode_samples(sample, 8 * sizeof(T), reinterpret_cast<const std::byte*>(stored.data()), gap * sizeof(T),
                   static_cast<int>(codes.size()), values.data());
    EXPECT_EQ(values.back(), 7.0f) << "writes past the last";
    values.pop_back();
    return values;
}

template <class T, class Expected>
void expect_all(SampleKind sample, const Expected& expected) {
    std::vector<T> codes(std::size_t{1} << (8 * sizeof(T)));
    for (std::size_t k = 0; k < codes.size(); ++k) codes[k] = static_cast<T>(k);
    on_every_target([&] {
        for (const std::size_t gap : {std::size_t{1}, std::size_t{3}}) {
            const std::vector<float> values = decoded(sample, codes, gap);
            for (std::size_t k = 0; k < codes.size(); ++k) {
                ASSERT_EQ(std::bit_cast<std::uint32_t>(values[k]), std::bit_cast<std::uint32_t>(expected(codes[k])))
                    << k;
            }
        }
    });
}

TEST(Samples, FractionsAreThoseOfDivision) {
    expect_all<std::uint8_t>(SampleKind::unorm, [](std::uint8_t code) { return static_cast<float>(code) / 255.0f; });
    expect_all<std::uint16_t>(SampleKind::unorm,
                              [](std::uint16_t code) { return static_cast<float>(code) / 65535.0f; });
    expect_all<std::int8_t>(SampleKind::snorm,
                            [](std::int8_t code) { return std::max(static_cast<float>(code) / 127.0f, -1.0f); });
    expect_all<std::int16_t>(SampleKind::snorm,
                             [](std::int16_t code) { return std::max(static_cast<float>(code) / 32767.0f, -1.0f); });
}

// Compares with Imath's table, including numbers below 2^-14, infinity and every NaN.
TEST(Samples, HalvesAreThoseOfImath) {
    expect_all<std::uint16_t>(SampleKind::floating, [](std::uint16_t code) {
        Imath::half value;
        value.setBits(code);
        return static_cast<float>(value);
    });
}

TEST(Samples, AnyCountLeavesTheNextSampleAlone) {
    on_every_target([] {
        for (std::size_t count = 0; count < 600; ++count) {
            const std::vector<float> values = decoded(SampleKind::unorm, std::vector<std::uint8_t>(count, 255), 3);
            EXPECT_TRUE(std::all_of(values.begin(), values.end(), [](float value) { return value == 1.0f; })) << count;
        }
    });
}

}  // namespace
}  // namespace tex
