// SPDX-License-Identifier: Apache-2.0

#include "formats/size_limits.h"

#include <gtest/gtest.h>

namespace tex {
namespace {

TEST(Claims, AnExtentIsCheckedWithoutOverflow) {
    const ReadOptions options;
    EXPECT_EQ(*claimed_extent("f", 7, 5, options), (Extent{7, 5}));
    EXPECT_EQ(claimed_extent("f", 0, 5, options).error().code, ErrorCode::bad_data);
    EXPECT_EQ(claimed_extent("f", 5, -1, options).error().code, ErrorCode::bad_data);
    EXPECT_EQ(claimed_extent("f", kMaxExtent + 1, 1, options).error().code, ErrorCode::unsupported);
    EXPECT_EQ(claimed_extent("f", kMaxExtent, kMaxExtent, options).error().code, ErrorCode::unsupported);
    EXPECT_EQ(claimed_extent("f", INT64_MAX, INT64_MAX, options).error().code, ErrorCode::unsupported);
    EXPECT_EQ(claimed_extent("f", 1 << 15, 1 << 15, options)->texels(), options.max_texels);
    EXPECT_EQ(claimed_extent("f", 1 << 15, (1 << 15) + 1, options).error().reason,
              "32768x32769 texels are more than the limit of 1073741824");
}

TEST(Claims, ContentIsHeldAgainstTheBestCompression) {
    EXPECT_TRUE(check_claim("f", {10, 10}, 1000, 100, 10.0));
    const Result<void> more = check_claim("f", {10, 10}, 1001, 100, 10.0);
    ASSERT_FALSE(more);
    EXPECT_EQ(more.error().code, ErrorCode::bad_data);
    EXPECT_EQ(more.error().reason, "claims 10x10 texels, more than its 100 bytes can hold");
}

TEST(Claims, ChannelsAreNamedByTheirCount) {
    EXPECT_EQ(channel_names(1), (std::vector<std::string>{"Y"}));
    EXPECT_EQ(channel_names(2), (std::vector<std::string>{"Y", "A"}));
    EXPECT_EQ(channel_names(4), (std::vector<std::string>{"R", "G", "B", "A"}));
    const Image image = make_image({3, 2}, {"R", "G"});
    ASSERT_EQ(image.planes.size(), 2u);
    EXPECT_EQ(image.planes[1].extent(), (Extent{3, 2}));
}

}  // namespace
}  // namespace tex
