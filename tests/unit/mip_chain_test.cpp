// SPDX-License-Identifier: Apache-2.0

#include <tex/types.h>

#include <gtest/gtest.h>

namespace {

using tex::Extent;
using tex::level_count;
using tex::level_extent;

TEST(MipChain, ACompleteChainHasOneLevelMoreThanItsSidesCanBeHalved) {
    EXPECT_EQ(level_count({1, 1}), 1);
    EXPECT_EQ(level_count({2, 1}), 2);
    EXPECT_EQ(level_count({3, 3}), 2);
    EXPECT_EQ(level_count({1, 300}), 9);
    EXPECT_EQ(level_count({300, 1}), 9);
    EXPECT_EQ(level_count({5, 7}), 3);
    EXPECT_EQ(level_count({253, 253}), 8);
    EXPECT_EQ(level_count({1025, 1025}), 11);
    EXPECT_EQ(level_count({4096, 4096}), 13);
    EXPECT_EQ(level_count({tex::kMaxExtent, 1}), 21);
}

TEST(MipChain, LevelsAreHalvedRoundedDownButNotBelowOne) {
    EXPECT_EQ(level_extent({253, 100}, 0), (Extent{253, 100}));
    EXPECT_EQ(level_extent({253, 100}, 1), (Extent{126, 50}));
    EXPECT_EQ(level_extent({253, 100}, 4), (Extent{15, 6}));
    EXPECT_EQ(level_extent({253, 100}, 7), (Extent{1, 1}));
    EXPECT_EQ(level_extent({1, 300}, 3), (Extent{1, 37}));
    EXPECT_EQ(level_extent({16, 2}, 3), (Extent{2, 1}));
}

TEST(MipChain, TheLastLevelIsOneTexelAndSoIsEveryOneAfterIt) {
    for (const Extent base : {Extent{1, 1}, Extent{5, 7}, Extent{1025, 3}}) {
        EXPECT_EQ(level_extent(base, level_count(base) - 1), (Extent{1, 1}));
        EXPECT_EQ(level_extent(base, 1000), (Extent{1, 1}));
    }
}

}  // namespace
