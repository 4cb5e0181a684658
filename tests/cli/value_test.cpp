// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "cli/usage_error.h"
#include "cli/value.h"

namespace tex::cli {

TEST(Value, NumbersAreReadWhole) {
    EXPECT_EQ(parse_float("-8"), -8.0f);
    EXPECT_EQ(parse_float("+.5e1"), 5.0f);
    EXPECT_EQ(parse_double("0.1"), 0.1);
    EXPECT_EQ(parse_int("12", 0, 20), 12);
    for (const char* text :
         {"", "8x", " 8", "8 ", "0x10", "1,5", "--8", "+-8", "nan", "inf", "-inf", "infinity", "1e999"}) {
        EXPECT_THROW((void)parse_float(text), UsageError) << text;
        EXPECT_THROW((void)parse_double(text), UsageError) << text;
        EXPECT_THROW((void)parse_int(text, -100, 100), UsageError) << text;
    }
    EXPECT_THROW((void)parse_int("1.5", 0, 20), UsageError);
    EXPECT_THROW((void)parse_int("99999999999", 0, 20), UsageError);
}

TEST(Value, RangesAreKept) {
    EXPECT_EQ(parse_float("0", {0.0, 1.0, true}), 0.0f);
    EXPECT_THROW((void)parse_float("0", {0.0, 1.0, false}), UsageError);
    EXPECT_EQ(parse_float("1", {0.0, 1.0, false}), 1.0f);
    EXPECT_THROW((void)parse_float("1.0001", {0.0, 1.0, false}), UsageError);
    EXPECT_THROW((void)parse_int("21", 0, 20), UsageError);
}

TEST(Value, CountsHaveSuffixes) {
    EXPECT_EQ(parse_count("65536"), 65536);
    EXPECT_EQ(parse_count("512M"), std::int64_t{512} << 20);
    EXPECT_EQ(parse_count("4g"), std::int64_t{4} << 30);
    for (const char* text : {"", "M", "0", "-1", "1.5G", "1MB", "9999999T"}) {
        EXPECT_THROW((void)parse_count(text), UsageError) << text;
    }
    for (const std::int64_t count : {std::int64_t{1}, std::int64_t{1000}, std::int64_t{65536}, std::int64_t{3} << 30}) {
        EXPECT_EQ(parse_count(count_text(count)), count);
    }
    EXPECT_EQ(count_text(std::int64_t{4} << 30), "4G");
}

}  // namespace tex::cli
