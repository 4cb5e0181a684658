// SPDX-License-Identifier: Apache-2.0
// Compares the pruned search for palettes of EAC blocks with an exhaustive one, which scores every base, multiplier and
// table with the nearest of the eight codes for each texel: the errors are equal, to the last bit.

#include "kernels/eac_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <tex/file.h>

#include "kernels/encode.h"
#include "reference/real_maps.h"
#include "rows/codecs.h"
#include "unit/packing.h"
#include "unit/targets.h"
#include "unit/textures.h"

namespace tex {
namespace {

// Blocks of all kinds: constant, two-valued, ramps, noise of every range, clusters, at the ends of the range, partly
// outside the level, on the grid of 11 bits and between its codes.
std::vector<BlockTexels> special_blocks(int top, int trials) {
    std::vector<BlockTexels> blocks;
    std::mt19937 random(11);
    const int most = top * kEacUnit;
    const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(std::max(n, 1))); };
    const auto add = [&](auto value) {
        BlockTexels block;
        for (int k = 0; k < 16; ++k) block.values[k] = std::clamp(value(k), 0, most);
        blocks.push_back(block);
    };
    for (int code = 0; code <= top; code += 63) add([&](int) { return code * kEacUnit; });
    for (const int code : {0, 1, 7, top - 7, top - 1, top}) add([&](int) { return code * kEacUnit; });
    for (int trial = 0; trial < trials; ++trial) {
        const int a = below(most), b = below(most), range = 1 << (6 + trial % 13);
        add([&](int) { return a; });
        add([&](int k) { return k % 3 == 0 ? a : b; });
        add([&](int k) { return a + k % 4 * range / 16 + k / 4 * range / 8; });
        add([&](int) { return a + below(range); });
        add([&](int) { return (a + below(range)) / kEacUnit * kEacUnit; });
        add([&](int) { return a + below(3) * range + below(range / 8); });
        add([&](int) { return below(range); });
        add([&](int) { return most - below(range); });
        add([&](int k) { return k == 3 ? 0 : k == 7 ? most : a + below(range); });
        add([&](int k) { return k % 2 == 0 ? below(range / 2) : most - below(range / 2); });
        const EacPalette palette{below(256), below(16), below(16)};  // what such a palette gives, and a little noise
        const int scale = palette.multiplier == 0 ? kEacUnit : 8 * palette.multiplier * kEacUnit;
        add([&](int) {
            return 8 * kEacUnit * palette.base + scale * kEacModifiers[palette.table][below(8)] + below(200) - 100;
        });
        add([&](int) { return a + below(range); });
        blocks.back().mask = trial % 3 == 0 ? 0x000Fu : trial % 3 == 1 ? 0x0001u : 0x0777u;
    }
    return blocks;
}

// The blocks of real maps, in x and in y.
void add_real_blocks(int top, int blocks_of_each, std::vector<BlockTexels>& blocks) {
    for (const reference::RealMap& real : reference::real_maps()) {
        const bool is_normal_map = real.path.starts_with("normal/") || real.path.starts_with("pairs/");
        if (!is_normal_map || !real.path.ends_with(".png")) continue;  // others need the reader, which arm64 lacks
        const auto image = read_image((shared_data() / real.path).string());
        ASSERT_TRUE(image) << image.error().message();
        const Extent extent = image->extent();
        const int across = extent.width / 4;
        const int count = across * (extent.height / 4);
        for (int n = 0; n < blocks_of_each; ++n) {
            const int at = static_cast<int>(static_cast<std::int64_t>(n) * 7919 % count);
            BlockTexels block;
            for (int k = 0; k < 16; ++k) {
                const Plane<float>& plane = image->planes[static_cast<std::size_t>(n % 2)];
                block.values[k] =
                    to_eac_units(2.0f * plane.at(at % across * 4 + k % 4, at / across * 4 + k / 4) - 1.0f, top);
            }
            blocks.push_back(block);
        }
    }
}

using Blocks = std::vector<std::array<std::byte, 16>>;

Blocks encode(const std::vector<BlockTexels>& texels, EacCodes codes, Effort effort) {
    const int count = static_cast<int>(texels.size());
    std::vector<ClusterBounds> bounds(texels.size());
    Blocks blocks(texels.size());
    cluster_bounds(texels.data(), count, bounds.data());
    encode_eac_blocks(texels.data(), bounds.data(), count, codes, effort, blocks.front().data());
    return blocks;
}

// The squared error of a decoded block, in units of (1/kEacUnit code)^2: whole numbers.
std::int64_t error_of(const BlockTexels& texels, EacCodes codes, const std::byte* block) {
    const bool is_signed = codes.bias != 0;
    float values[16];
    (is_signed ? decode_eac_snorm : decode_eac_unorm)(block, values);
    std::int64_t sum = 0;
    for (int k = 0; k < 16; ++k) {
        if (!(texels.mask >> k & 1)) continue;
        const auto code = is_signed ? std::lround(values[k] * 1023.0f) + 1023 : std::lround(values[k] * 2047.0f);
        const std::int64_t d = texels.values[k] - code * kEacUnit;
        sum += d * d;
    }
    return sum;
}

// The least error of all palettes.
std::int64_t exhaustive(const BlockTexels& texels, EacCodes codes, std::int64_t least) {
    for (int multiplier = 0; multiplier < 16; ++multiplier) {
        const int scale = multiplier == 0 ? kEacUnit : 8 * multiplier * kEacUnit;
        for (const auto& modifiers : kEacModifiers) {
            for (int base = 0; base < codes.bases; ++base) {
                std::int64_t sum = 0;
                int palette[8];
                for (int k = 0; k < 8; ++k) {
                    palette[k] = std::clamp((8 * base + codes.middle) * kEacUnit + scale * modifiers[k], 0,
                                            codes.top * kEacUnit);
                }
                for (int k = 0; k < 16 && sum < least; ++k) {
                    if (!(texels.mask >> k & 1)) continue;
                    int nearest = 1 << 30;
                    for (const int code : palette) nearest = std::min(nearest, std::abs(texels.values[k] - code));
                    sum += std::int64_t{nearest} * nearest;
                }
                least = std::min(least, sum);
            }
        }
    }
    return least;
}

void expect_optimal(const std::vector<BlockTexels>& texels, EacCodes codes) {
    const Blocks blocks = encode(texels, codes, Effort::best);
    for (std::size_t k = 0; k < texels.size(); ++k) {
        const std::int64_t error = error_of(texels[k], codes, blocks[k].data());
        ASSERT_EQ(error, exhaustive(texels[k], codes, error)) << "block " << k;
    }
}

// With the real blocks below, more than 10,000 blocks.
TEST(EacSearch, FindsTheOptimumOfEveryBlock) {
    for (const EacCodes codes : {kEacUnorm, kEacSnorm}) expect_optimal(special_blocks(codes.top, 350), codes);
}

TEST(EacSearch, StoresEveryCodeOfABlockOfOneValue) {
    for (const EacCodes codes : {kEacUnorm, kEacSnorm}) {
        std::vector<BlockTexels> texels;
        for (int code = 0; code <= codes.top; ++code) {
            BlockTexels block;
            std::fill(std::begin(block.values), std::end(block.values), code * kEacUnit);
            texels.push_back(block);
        }
        const Blocks blocks = encode(texels, codes, Effort::normal);
        for (std::size_t k = 0; k < texels.size(); ++k) EXPECT_EQ(error_of(texels[k], codes, blocks[k].data()), 0) << k;
    }
}

TEST(EacSearch, FindsTheOptimumOfRealBlocks) {
    TEX_NEEDS_SHARED_DATA();
    for (const EacCodes codes : {kEacUnorm, kEacSnorm}) {
        std::vector<BlockTexels> blocks;
        add_real_blocks(codes.top, 100, blocks);
        expect_optimal(blocks, codes);
    }
}

TEST(EacSearch, FindsTheSamePalettesOnEveryTarget) {
    const std::vector<BlockTexels> texels = special_blocks(kEacUnorm.top, 60);
    for (const Effort effort : {Effort::best, Effort::normal}) {
        const Blocks expected = encode(texels, kEacUnorm, effort);
        on_every_target([&] { EXPECT_EQ(encode(texels, kEacUnorm, effort), expected); });
    }
}

// Rows of blocks, of which the last are partly outside the level.
constexpr int kWidth = 4 * 77 + 3;

std::vector<float> noisy_rows() {
    std::vector<float> rows(4 * kWidth);
    std::mt19937 random(5);
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const float range = 1.0f / static_cast<float>(1 << (k % 320 / 40));
        rows[k] = 1.1f * range * (static_cast<float>(random() % 2001) / 1000.0f - 1.0f);
    }
    return rows;
}

std::vector<std::byte> encode_rows(const std::vector<float>& values, Encoding encoding, Effort effort) {
    BlockRow row;
    for (int k = 0; k < 4; ++k) row.x[k] = row.y[k] = values.data() + k * kWidth;
    row.width = kWidth;
    row.negate_y = true;
    std::vector<std::byte> blocks(16 * 78);
    encode_blocks(row, {encoding, YAxis::up, effort}, blocks.data());
    return blocks;
}

double error_of(const std::vector<float>& values, const std::vector<std::byte>& blocks, Encoding encoding) {
    double sum = 0;
    for (int i = 0; i < kWidth; ++i) {
        float x[16], y[16];
        const std::byte* block = blocks.data() + 16 * static_cast<std::ptrdiff_t>(i / 4);
        packing::decode_codes(block, encoding, x, y);
        for (int j = 0; j < 4; ++j) {
            const auto n =
                static_cast<double>(std::clamp(values[static_cast<std::size_t>(j * kWidth + i)], -1.0f, 1.0f));
            const int k = 4 * j + i % 4;
            sum += std::pow(static_cast<double>(x[k]) / 127.5 - 1.0 - n, 2);
            sum += std::pow(static_cast<double>(y[k]) / 127.5 - 1.0 + n, 2);
        }
    }
    return sum;
}

TEST(EacEncode, GivesTheSameBlocksOnEveryTarget) {
    const std::vector<float> values = noisy_rows();
    for (const Encoding encoding : {Encoding::eac_rg11, Encoding::eac_rg11_snorm}) {
        for (const auto& effort : kEffortNames) {
            const std::vector<std::byte> expected = encode_rows(values, encoding, effort.value);
            on_every_target([&] { EXPECT_EQ(encode_rows(values, encoding, effort.value), expected) << effort.name; });
        }
    }
}

TEST(EacEncode, NoEffortIsWorseThanACheaperOne) {
    const std::vector<float> values = noisy_rows();
    for (const Encoding encoding : {Encoding::eac_rg11, Encoding::eac_rg11_snorm}) {
        const double fast = error_of(values, encode_rows(values, encoding, Effort::fast), encoding);
        const double normal = error_of(values, encode_rows(values, encoding, Effort::normal), encoding);
        const double best = error_of(values, encode_rows(values, encoding, Effort::best), encoding);
        EXPECT_LE(best, normal);
        EXPECT_LT(normal, 1.15 * best);
        EXPECT_LT(fast, 2.0 * best);
    }
}

// Coarse maps: two or three values, 8 or 9 codes of 8 bits apart. Palettes in the middle of such a range miss them.
TEST(EacEncode, FastFitsFewValuesFarApart) {
    std::vector<float> values(4 * kWidth);
    std::mt19937 random(9);
    for (int block = 0; 4 * block < kWidth; ++block) {
        const int first = 64 + static_cast<int>(random() % 128), step = 8 + static_cast<int>(random() % 2);
        for (int k = 0; k < 16; ++k) {
            const int i = std::min(4 * block + k % 4, kWidth - 1), code = first + step * static_cast<int>(random() % 3);
            values[static_cast<std::size_t>(k / 4 * kWidth + i)] = static_cast<float>(code) / 127.5f - 1.0f;
        }
    }
    const double fast = error_of(values, encode_rows(values, Encoding::eac_rg11, Effort::fast), Encoding::eac_rg11);
    EXPECT_LT(std::sqrt(fast / (8.0 * kWidth)) * 127.5, 0.75);  // in codes of 8 bits
}

}  // namespace
}  // namespace tex
