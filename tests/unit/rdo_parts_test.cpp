// SPDX-License-Identifier: Apache-2.0
// The promise of rate-distortion optimisation in every square of 512x512 texels, also where squares differ.

#include "rows/rdo_parts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <vector>

#include <gtest/gtest.h>
#include <tex/tex.h>

#include "unit/packing.h"

namespace tex {
namespace {

// Squares take turns: slow waves, whose angles are small, and steep bumps.
NormalMap smooth_and_steep(Extent extent) {
    NormalMap map(extent);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const bool is_steep = (i / 512 + j / 512) % 2 == 1;
            const double u = is_steep ? 1.5 * std::sin(0.9 * i + 0.3 * j) + 0.8 * std::cos(0.017 * i * j) : 0.3;
            const double v = is_steep ? 1.5 * std::cos(0.7 * j - 0.2 * i) : 0.2 * std::sin(0.02 * i + 0.05 * j);
            const double length = std::sqrt(u * u + v * v + 1.0);
            map.x.at(i, j) = static_cast<float>(u / length);
            map.y.at(i, j) = static_cast<float>(v / length);
            map.z.at(i, j) = static_cast<float>(1.0 / length);
        }
    }
    return map;
}

struct Squares {
    std::vector<double> means, greatest;
    RdoReport rdo;
};

// The angles in each square of 512x512 texels.
Squares pack_squares(const MipChain& chain, const PackOptions& options) {
    const Extent extent = chain.levels[0].extent();
    const auto texture = pack(chain, options, {1, {}});
    EXPECT_TRUE(texture);
    const auto compared = compare(chain.levels[0], unpack(*texture)->levels[0]);
    EXPECT_TRUE(compared);
    const int across = (extent.width + 511) / 512, down = (extent.height + 511) / 512;
    const auto count = static_cast<std::size_t>(across * down);
    Squares squares{std::vector<double>(count), std::vector<double>(count), texture->rdo};
    std::vector<double> texels(count);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const auto k = static_cast<std::size_t>(j / 512 * across + i / 512);
            const double degrees = compared->degrees.at(i, j);
            squares.means[k] += degrees;
            squares.greatest[k] = std::max(squares.greatest[k], degrees);
            ++texels[k];
        }
    }
    for (std::size_t k = 0; k < count; ++k) squares.means[k] /= texels[k];
    return squares;
}

void expect_promise_in_squares(Extent extent, Encoding encoding) {
    constexpr float kMean = 0.5f;
    const MipChain chain = packing::chain_of(smooth_and_steep(extent));
    PackOptions options{encoding, YAxis::up, Effort::fast};
    const Squares plain = pack_squares(chain, options);
    options.rdo = {kMean, 0.0f, 2048};
    const Squares small = pack_squares(chain, options);
    EXPECT_LE(small.rdo.most_growth, 0.5);
    EXPECT_GT(small.rdo.mean, small.rdo.plain_mean + 0.1) << "something was gained";
    for (std::size_t k = 0; k < plain.means.size(); ++k) {
        EXPECT_LE(small.means[k], plain.means[k] + 0.5 + 1e-3) << name_of(kEncodingNames, encoding) << ' ' << k;
        EXPECT_LE(small.greatest[k], std::max(plain.greatest[k], 4.0 * (plain.means[k] + 0.5) + 0.01))
            << name_of(kEncodingNames, encoding) << ' ' << k;
    }
}

TEST(RdoParts, EverySquareKeepsThePromiseForEveryBlockSize) {
    for (const auto& row : kEncodingNames) {
        if (can_optimise(row.value)) expect_promise_in_squares({1024, 64}, row.value);
    }
}

TEST(RdoParts, HighAndWideMapsKeepItToo) {
    for (const Encoding encoding : {Encoding::bc5, Encoding::dxt5nm, Encoding::astc_6x6, Encoding::astc_8x8}) {
        expect_promise_in_squares({64, 1536}, encoding);
        expect_promise_in_squares({4096, 64}, encoding);
    }
}

TEST(RdoParts, BlocksBelongToTheSquareOfTheirMiddle) {
    // 1024 texels are 171 blocks of 6: block 85 is at 510 to 515.
    const std::vector<int> row = RdoParts({1024, 512}, 0).of_blocks({6, 6}, 171, 1);
    EXPECT_EQ(row[84], 0);
    EXPECT_EQ(row[85], 1);
    EXPECT_EQ(row[170], 1);
    // From row 768 on, a band of 768 rows has the rest of one square and all of the next.
    const std::vector<int> band = RdoParts({512, 2048}, 768).of_blocks({6, 6}, 86, 128);
    EXPECT_EQ(band[0], 0);
    EXPECT_EQ(band[86 * 42], 0) << "rows 1020 to 1025, whose middle is 1023";
    EXPECT_EQ(band[86 * 43], 1);
    EXPECT_EQ(band.back(), 1);
    // The texels themselves count where they are.
    const RdoParts parts({512, 2048}, 768);
    EXPECT_EQ(parts.at(0, 1023 - 768), 0);
    EXPECT_EQ(parts.at(0, 1024 - 768), 1);
}

TEST(RdoParts, SmallRestsBelongToTheSquareBesideThem) {
    const auto parts_of = [](int width, int height) {
        const std::vector<int> parts =
            RdoParts({width, height}, 0).of_blocks({4, 4}, (width + 3) / 4, (height + 3) / 4);
        return std::set<int>(parts.begin(), parts.end()).size();
    };
    EXPECT_EQ(parts_of(1, 1), 1u);
    EXPECT_EQ(parts_of(512, 512), 1u);
    EXPECT_EQ(parts_of(575, 512), 1u);
    EXPECT_EQ(parts_of(576, 512), 2u);
    EXPECT_EQ(parts_of(1024, 575), 2u);
    EXPECT_EQ(parts_of(1025, 1025), 4u);
}

}  // namespace
}  // namespace tex
