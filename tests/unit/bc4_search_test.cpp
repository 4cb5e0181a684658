// SPDX-License-Identifier: Apache-2.0
// Compares the pruned searches for endpoints with the exhaustive ones: the errors are equal, to the last bit.

#include "kernels/bc4_search.h"
#include "kernels/clusters.h"
#include "kernels/green_search.h"

#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include "reference/exhaustive_search.h"

namespace {

using tex::BlockTexels;

// Blocks of all kinds: constant, two-valued, ramps, noise, clusters, at the ends of the range, and partly outside it,
// with and without fractions of a code.
std::vector<BlockTexels> special_blocks(int top) {
    std::vector<BlockTexels> blocks;
    std::mt19937 random(7);
    const int unit = tex::kCodeUnit;
    const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
    const auto add = [&](auto value) {
        BlockTexels block;
        for (int k = 0; k < 16; ++k) block.values[k] = std::min(std::max(value(k), 0), top * unit);
        blocks.push_back(block);
    };
    for (int code = 0; code <= top; code += 5) add([&](int) { return code * unit; });
    for (int trial = 0; trial < 24; ++trial) {
        const int a = below(top * unit), b = below(top * unit), c = below(top);
        add([&](int) { return a; });
        add([&](int k) { return k % 3 == 0 ? a : b; });
        add([&](int k) { return (k % 5 == 0 ? c : top - c) * unit; });
        const int slope = below(30 * unit) / 16;
        add([&](int k) { return a + k * slope; });
        add([&](int k) { return c * unit + k % 4 * slope / 4 + k / 4 * slope; });
        const int range = 1 << (1 + trial % 8);
        add([&](int) { return c * unit + below(range * unit); });
        add([&](int) { return (c + below(range)) * unit; });
        add([&](int) { return (below(3) * range / 2 + c + below(2)) * unit; });
        add([&](int) { return below(range * unit); });
        add([&](int) { return top * unit - below(range) * unit; });
        add([&](int k) { return k == 3 ? 0 : k == 7 ? top * unit : (c + below(9)) * unit; });
        blocks.back().mask = trial % 2 ? 0xFFFFu : 0x3333u;
        add([&](int) { return (c + below(range)) * unit; });
        blocks.back().mask = trial % 3 == 0 ? 0x000Fu : trial % 3 == 1 ? 0x0001u : 0x0077u;
        add([&](int) { return c * unit + below(range * unit); });
        blocks.back().mask = 0x0777u;
    }
    return blocks;
}

std::vector<tex::ClusterBounds> bounds_of(const std::vector<BlockTexels>& blocks) {
    std::vector<tex::ClusterBounds> bounds(blocks.size());
    tex::cluster_bounds(blocks.data(), static_cast<int>(blocks.size()), bounds.data());
    return bounds;
}

template <class Test>
void on_every_target(Test test) {
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        hwy::SetSupportedTargetsForTest(target);
        SCOPED_TRACE(hwy::TargetName(target));
        test();
    }
    hwy::SetSupportedTargetsForTest(0);
}

TEST(Bc4Search, FindsTheOptimumOfEveryBlock) {
    for (const tex::Bc4Codes codes : {tex::kBc4Unorm, tex::kBc4Snorm}) {
        const std::vector<BlockTexels> blocks = special_blocks(codes.top);
        std::vector<tex::Bc4Endpoints> found(blocks.size());
        tex::search_bc4_blocks(blocks.data(), bounds_of(blocks).data(), static_cast<int>(blocks.size()), codes,
                               found.data());
        for (std::size_t k = 0; k < blocks.size(); ++k) {
            EXPECT_EQ(tex::bc4_error(blocks[k], codes, found[k]),
                      tex::reference::least_bc4_error(blocks[k], codes, codes.top))
                << k;
        }
    }
}

TEST(Bc4Search, FindsTheSameEndpointsOnEveryTarget) {
    const std::vector<BlockTexels> blocks = special_blocks(255);
    std::vector<tex::Bc4Endpoints> expected;
    on_every_target([&] {
        std::vector<tex::Bc4Endpoints> found(blocks.size());
        tex::search_bc4_blocks(blocks.data(), bounds_of(blocks).data(), static_cast<int>(blocks.size()), tex::kBc4Unorm,
                               found.data());
        if (expected.empty()) expected = found;
        for (std::size_t k = 0; k < blocks.size(); ++k) {
            EXPECT_EQ(found[k].e0, expected[k].e0);
            EXPECT_EQ(found[k].e1, expected[k].e1);
        }
    });
}

TEST(GreenSearch, FindsTheOptimumOfEveryBlock) {
    const std::vector<BlockTexels> blocks = special_blocks(255);
    std::vector<tex::GreenEndpoints> found(blocks.size());
    tex::search_green_blocks(blocks.data(), bounds_of(blocks).data(), static_cast<int>(blocks.size()), found.data());
    for (std::size_t k = 0; k < blocks.size(); ++k) {
        EXPECT_EQ(tex::green_error(blocks[k], found[k]), tex::reference::least_green_error(blocks[k], 63)) << k;
    }
}

TEST(GreenSearch, FindsTheSameEndpointsOnEveryTarget) {
    const std::vector<BlockTexels> blocks = special_blocks(255);
    std::vector<tex::GreenEndpoints> expected;
    on_every_target([&] {
        std::vector<tex::GreenEndpoints> found(blocks.size());
        tex::search_green_blocks(blocks.data(), bounds_of(blocks).data(), static_cast<int>(blocks.size()),
                                 found.data());
        if (expected.empty()) expected = found;
        for (std::size_t k = 0; k < blocks.size(); ++k) {
            EXPECT_EQ(found[k].e0, expected[k].e0);
            EXPECT_EQ(found[k].e1, expected[k].e1);
        }
    });
}

// The bounds are valid: no set of k values from a palette has a smaller error.
TEST(ClusterBounds, AreBelowTheErrorOfEveryPalette) {
    const std::vector<BlockTexels> blocks = special_blocks(255);
    const std::vector<tex::ClusterBounds> bounds = bounds_of(blocks);
    const double unit = static_cast<double>(tex::kBc4ErrorUnit);
    const double green_unit = static_cast<double>(tex::kGreenErrorUnit);
    for (std::size_t k = 0; k < blocks.size(); ++k) {
        const auto error = static_cast<double>(tex::reference::least_bc4_error(blocks[k], tex::kBc4Unorm, 2));
        EXPECT_LE(bounds[k].bound[7], error / unit / unit * 1.000001) << k;
        const auto green_error = static_cast<double>(tex::reference::least_green_error(blocks[k], 2));
        EXPECT_LE(bounds[k].bound[3], green_error / green_unit / green_unit * 1.000001) << k;
        for (int c = 1; c < tex::kMaxClusters; ++c) EXPECT_LE(bounds[k].bound[c], bounds[k].bound[c - 1]);
    }
}

}  // namespace
