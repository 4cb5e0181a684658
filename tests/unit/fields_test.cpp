// SPDX-License-Identifier: Apache-2.0

#include "formats/dds/fields.h"

#include <cmath>
#include <cstring>
#include <vector>

#include <gtest/gtest.h>

namespace tex {
namespace {

TEST(Fields, PickTheSmallestFormatThatHoldsThem) {
    EXPECT_EQ(format_of({1, {0xff, 0, 0, 0}, false}), Format::r8_unorm);
    EXPECT_EQ(format_of({2, {0xffff, 0, 0, 0}, false}), Format::r16_unorm);
    EXPECT_EQ(format_of({3, {0xff0000, 0xff00, 0xff, 0}, false}), Format::rgb8_unorm);
    EXPECT_EQ(format_of({2, {0xf00, 0xf0, 0xf, 0xf000}, false}), Format::rgba8_unorm);      // 4 bits are exact in 8
    EXPECT_EQ(format_of({2, {0x7c00, 0x3e0, 0x1f, 0x8000}, false}), Format::rgba16_unorm);  // 5 are not
    EXPECT_EQ(format_of({4, {0xffff, 0xffff0000, 0, 0}, false}), Format::rg16_unorm);
    EXPECT_EQ(format_of({2, {0xff, 0xff00, 0, 0}, true}), Format::rg8_snorm);
    EXPECT_EQ(format_of({1, {0, 0, 0, 0xff}, false}), Format::rgba8_unorm);
}

TEST(Fields, RefuseMasksThatMakeNoSense) {
    EXPECT_EQ(format_of({4, {0, 0, 0, 0}, false}), std::nullopt);
    EXPECT_EQ(format_of({4, {0xff00ff, 0, 0, 0}, false}), std::nullopt);    // two groups of bits
    EXPECT_EQ(format_of({2, {0xff0000, 0, 0, 0}, false}), std::nullopt);    // outside the texel
    EXPECT_EQ(format_of({4, {0xffffffff, 0, 0, 0}, false}), std::nullopt);  // wider than 16 bits
    EXPECT_EQ(format_of({2, {0x1f, 0x3e0, 0, 0}, true}), std::nullopt);     // signed, with 5 bits
    EXPECT_EQ(format_of({4, {0xff, 0xffff00, 0, 0}, true}), std::nullopt);  // signed, with 8 and 16 bits
}

// Every code of every width becomes the nearest code of the format.
TEST(Fields, RoundToTheNearestCode) {
    for (int width = 1; width <= 16; ++width) {
        const FieldLayout layout{2, {(1u << width) - 1, 0, 0, 0}, false};
        const auto format = format_of(layout);
        ASSERT_TRUE(format);
        const int bits = format_info(*format).bits;
        const double greatest = (1 << bits) - 1;
        for (std::uint32_t code = 0; code < 1u << width; ++code) {
            std::byte texel[2];
            std::memcpy(texel, &code, 2);
            std::uint32_t converted = 0;
            convert_fields(layout, texel, 1, *format, reinterpret_cast<std::byte*>(&converted));
            const double exact = code * greatest / ((1 << width) - 1);
            ASSERT_LE(std::abs(converted - exact), 0.5) << width << " bits, code " << code;
        }
    }
}

}  // namespace
}  // namespace tex
