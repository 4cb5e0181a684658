// SPDX-License-Identifier: Apache-2.0
// Blocks optimised for the angle, checked against the palettes that the decoders give.

#include "kernels/angle_search.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include "rows/codecs.h"
#include "unit/packing.h"

namespace {

using tex::Effort;
using tex::Encoding;

constexpr Encoding kEncodings[] = {Encoding::dxt5nm, Encoding::bc5, Encoding::bc5_snorm};
constexpr int kBlocks = 12;

struct Normal {
    double x, y, z;
    Normal(double x_of, double y_of) : x(x_of), y(y_of), z(std::sqrt(1.0 - std::min(1.0, x * x + y * y))) {
        const double length = std::max(1.0, std::hypot(x, y));
        x /= length;
        y /= length;
    }
    [[nodiscard]] double chord(const Normal& n) const {
        return (x - n.x) * (x - n.x) + (y - n.y) * (y - n.y) + (z - n.z) * (z - n.z);
    }
};

// A row of steep, rough blocks, and their bytes.
struct Row {
    tex::NormalMap map = packing::bumpy({4 * kBlocks, 4}, 11);
    tex::BlockRow row;
    Row() {
        for (int k = 0; k < 4; ++k) {
            row.x[k] = map.x.row(k);
            row.y[k] = map.y.row(k);
        }
        row.width = 4 * kBlocks;
    }
    [[nodiscard]] std::vector<std::byte> encode(Encoding encoding, tex::Metric metric) const {
        std::vector<std::byte> blocks(16 * kBlocks);
        tex::encode_blocks(row, {encoding, tex::YAxis::up, Effort::best, metric}, blocks.data());
        return blocks;
    }
    [[nodiscard]] Normal normal(int block, int texel) const {
        return {static_cast<double>(map.x.at(4 * block + texel % 4, texel / 4)),
                static_cast<double>(map.y.at(4 * block + texel % 4, texel / 4))};
    }
};

std::vector<Normal> decoded(const std::byte* block, Encoding encoding) {
    float x[16], y[16];
    packing::decode_codes(block, encoding, x, y);
    std::vector<Normal> normals;
    for (int k = 0; k < 16; ++k)
        normals.emplace_back(static_cast<double>(x[k]) / 127.5 - 1.0, static_cast<double>(y[k]) / 127.5 - 1.0);
    return normals;
}

double sum_of(const Row& row, int block, const std::byte* bytes, Encoding encoding) {
    const std::vector<Normal> normals = decoded(bytes, encoding);
    double sum = 0;
    for (int k = 0; k < 16; ++k) sum += row.normal(block, k).chord(normals[static_cast<std::size_t>(k)]);
    return sum;
}

// The least sum with the block's endpoints: each texel uses the best of all pairs of values.
double least_sum(const Row& row, int block, std::vector<std::byte> bytes, Encoding encoding) {
    std::vector<Normal> pairs;
    for (int pair = 0; pair < 64; ++pair) {
        // All texels get the same indices: 3 bits each, or 2 bits for green.
        for (int k = 0; k < 6; ++k) {
            bytes[2 + static_cast<std::size_t>(k)] = static_cast<std::byte>(pair % 8 * 0x249249 >> (8 * (k % 3)));
            if (encoding != Encoding::dxt5nm)
                bytes[10 + static_cast<std::size_t>(k)] = static_cast<std::byte>(pair / 8 * 0x249249 >> (8 * (k % 3)));
            else if (k < 4)
                bytes[12 + static_cast<std::size_t>(k)] = static_cast<std::byte>(pair / 8 % 4 * 0x55);
        }
        pairs.push_back(decoded(bytes.data(), encoding)[0]);
    }
    double sum = 0;
    for (int k = 0; k < 16; ++k) {
        double least = 1e9;
        for (const Normal& pair : pairs) least = std::min(least, row.normal(block, k).chord(pair));
        sum += least;
    }
    return sum;
}

TEST(AngleSearch, NeverIncreasesABlocksAnglesAndTakesTheBestPairs) {
    const Row row;
    for (const Encoding encoding : kEncodings) {
        const std::vector<std::byte> before = row.encode(encoding, tex::Metric::component);
        const std::vector<std::byte> after = row.encode(encoding, tex::Metric::angle);
        double sum_before = 0, sum_after = 0;
        for (int block = 0; block < kBlocks; ++block) {
            const std::vector<std::byte> bytes(after.begin() + 16 * block, after.begin() + 16 * (block + 1));
            const double sum = sum_of(row, block, bytes.data(), encoding);
            EXPECT_LE(sum, sum_of(row, block, before.data() + 16 * block, encoding) + 1e-6);
            EXPECT_NEAR(sum, least_sum(row, block, bytes, encoding), 1e-5);
            sum_before += sum_of(row, block, before.data() + 16 * block, encoding);
            sum_after += sum;
        }
        EXPECT_LT(sum_after, 0.99 * sum_before);
    }
}

TEST(AngleSearch, LeavesNoStepOfOneAlphaEndpointThatGains) {
    const Row row;
    const std::vector<std::byte> after = row.encode(Encoding::dxt5nm, tex::Metric::angle);
    for (int block = 0; block < kBlocks; ++block) {
        const std::vector<std::byte> bytes(after.begin() + 16 * block, after.begin() + 16 * (block + 1));
        const double sum = sum_of(row, block, bytes.data(), Encoding::dxt5nm);
        for (std::size_t end = 0; end < 2; ++end) {
            for (int step = -3; step <= 3; ++step) {
                std::vector<std::byte> moved = bytes;
                const int code = std::to_integer<int>(bytes[end]) + step;
                if (code < 0 || code > 255) continue;
                moved[end] = static_cast<std::byte>(code);
                if ((moved[0] > moved[1]) != (bytes[0] > bytes[1])) continue;  // the palette changes its type
                EXPECT_GE(least_sum(row, block, moved, Encoding::dxt5nm), sum - 1e-5);
            }
        }
    }
}

TEST(AngleSearch, GivesTheSameBytesOnEveryTarget) {
    const Row row;
    for (const Encoding encoding : kEncodings) {
        const std::vector<std::byte> expected = row.encode(encoding, tex::Metric::angle);
        for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
            hwy::SetSupportedTargetsForTest(target);
            EXPECT_EQ(row.encode(encoding, tex::Metric::angle), expected) << hwy::TargetName(target);
        }
        hwy::SetSupportedTargetsForTest(0);
    }
}

}  // namespace
