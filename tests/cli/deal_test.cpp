// SPDX-License-Identifier: Apache-2.0
// How textures are dealt to the shards of a farm.

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include <gtest/gtest.h>

#include "tree/deal.h"

namespace tex::cli {
namespace {

using Hands = std::vector<std::vector<std::size_t>>;

std::int64_t cost_of(const std::vector<std::size_t>& hand, const std::vector<DealtTexture>& textures) {
    return std::accumulate(hand.begin(), hand.end(), std::int64_t{0},
                           [&](std::int64_t sum, std::size_t k) { return sum + textures[k].cost; });
}

// From 64x64 to 8192x8192, as in a real tree: many small ones, a few large ones.
std::vector<DealtTexture> tree(std::size_t count) {
    std::vector<DealtTexture> textures(count);
    std::uint32_t state = 1;
    for (DealtTexture& texture : textures) {
        state = state * 1664525 + 1013904223;
        const double u = (state >> 8) / 16777216.0;
        const int power = 6 + static_cast<int>(7.99 * u * u);
        texture.cost = std::int64_t{1} << (2 * power);
    }
    return textures;
}

}  // namespace

TEST(Deal, TheLargestComeFirstAndEachIsDealtOnce) {
    const std::vector<DealtTexture> textures = {
        {1, {}, false}, {7, {}, false}, {5, {}, false}, {4, {}, false}, {3, {}, false}};
    EXPECT_EQ(deal(textures, 1), (Hands{{0, 1, 2, 3, 4}}));
    EXPECT_EQ(deal(textures, 2), (Hands{{1, 4}, {0, 2, 3}}));
    EXPECT_EQ(deal(textures, 7).size(), 7u);
    EXPECT_EQ(deal({}, 3), Hands(3));
}

TEST(Deal, WhatATextureNeedsIsInItsShard) {
    // 0 is needed by 2 and 3, and needs 1; 5 can never be made.
    const std::vector<DealtTexture> textures = {{2, {1}, false},  {2, {}, false},  {100, {0}, false},
                                                {90, {0}, false}, {50, {}, false}, {1000, {0}, true}};
    EXPECT_EQ(deal(textures, 2), (Hands{{0, 1, 2}, {0, 1, 3, 4}}));
    const auto three = deal(textures, 3);
    EXPECT_EQ(three, (Hands{{0, 1, 2}, {0, 1, 3}, {4}}));
    for (const auto& hand : three) EXPECT_EQ(std::count(hand.begin(), hand.end(), 5u), 0);
    // What needs a texture that cannot be made fails with it, in the same shard.
    EXPECT_EQ(deal({{1, {}, true}, {5, {0}, false}}, 2), (Hands{{0, 1}, {}}));
}

TEST(Deal, TexturesThatNeedTheSameGoTogetherIfThatIsCheaper) {
    // 1 and 2 need 0, which is expensive. 3 is nearly as large as they are together.
    const std::vector<DealtTexture> textures = {{100, {}, false}, {1, {0}, false}, {1, {0}, false}, {95, {}, false}};
    EXPECT_EQ(deal(textures, 2), (Hands{{3}, {0, 1, 2}}));
}

TEST(Deal, WhatOnlyARefusedTextureNeedsIsDealt) {
    EXPECT_EQ(deal({{5, {}, false}, {7, {0}, true}, {1, {}, false}}, 2), (Hands{{0}, {2}}));
}

TEST(Deal, ShardsAreEqualInCost) {
    std::vector<DealtTexture> textures = tree(5000);
    for (std::size_t k = 1; k < textures.size(); k += 3) textures[k].needs = {0};
    for (const int shards : {3, 16, 64}) {
        const Hands hands = deal(textures, shards);
        std::int64_t sum = 0, most = 0;
        std::set<std::size_t> all;
        for (const auto& hand : hands) {
            sum += cost_of(hand, textures);
            most = std::max(most, cost_of(hand, textures));
            all.insert(hand.begin(), hand.end());
        }
        EXPECT_EQ(all.size(), textures.size());
        EXPECT_LT(static_cast<double>(most) * shards / static_cast<double>(sum), 1.01) << shards;
        EXPECT_EQ(hands, deal(textures, shards));
    }
}

}  // namespace tex::cli
