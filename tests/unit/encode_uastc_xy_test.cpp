// SPDX-License-Identifier: Apache-2.0
// UASTC of x and y: what is written is what the decoder gives, in the modes of luminance and alpha; how near the
// normals come that follow from both; no block depends on its neighbours or the instruction set; and hints that are
// those of a search over all of them.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "blocks/eac.h"
#include "blocks/uastc.h"
#include "blocks/uastc_modes.h"
#include "blocks/uastc_write.h"
#include "kernels/encode_uastc.h"
#include "kernels/uastc_xy_hints.h"
#include "unit/targets.h"

namespace tex {
namespace {

constexpr Effort kXyEfforts[] = {Effort::fast, Effort::normal, Effort::best};

std::size_t xy_place(int n) { return static_cast<std::size_t>(n); }

// Waves, an edge and noise.
std::vector<float> xy_bumps(Extent extent, double steepness) {
    std::mt19937 random(5);
    std::vector<float> texels;
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const double noise = static_cast<double>(random() % 1000) / 1000 - 0.5;
            const double x = steepness * std::sin(0.2 * i + 0.1 * j) + (i > extent.width / 2 ? 0.3 : 0.004) * noise;
            const double y = (i + 2 * j) % 40 < 20 ? 0.3 : -steepness * std::cos(0.07 * i);
            const double length = std::sqrt(x * x + y * y + 1);
            for (const double v : {x, y}) texels.push_back(static_cast<float>(v / length));
        }
    }
    return texels;
}

std::vector<std::byte> xy_blocks(Effort effort, const std::vector<float>& texels, Extent extent) {
    std::vector<std::byte> blocks(level_bytes(Format::uastc_4x4_unorm, extent));
    encode_uastc_xy(Format::uastc_4x4_unorm, effort, texels.data(), extent, blocks.data());
    return blocks;
}

void set_rebuilt(double x, double y, double to[3]) {
    const double flat = x * x + y * y, scale = flat > 1 ? 1 / std::sqrt(flat) : 1;
    to[0] = scale * x;
    to[1] = scale * y;
    to[2] = std::sqrt(std::max(0.0, 1 - flat));
}

// The mean angle in degrees between normals whose z is rebuilt. Red, green and blue are equal.
double xy_angle(const std::vector<std::byte>& blocks, const std::vector<float>& texels, Extent extent) {
    const int across = (extent.width + 3) / 4;
    double sum = 0;
    for (int n = 0; n < static_cast<int>(blocks.size() / 16); ++n) {
        std::uint8_t codes[4][16];
        decode_uastc(&blocks[xy_place(16 * n)], codes);
        for (int k = 0; k < 16; ++k) {
            EXPECT_TRUE(codes[0][k] == codes[1][k] && codes[1][k] == codes[2][k]);
            const int i = n % across * 4 + k % 4, j = n / across * 4 + k / 4;
            if (i >= extent.width || j >= extent.height) continue;
            const float* const texel = &texels[2 * xy_place(j * extent.width + i)];
            double found[3], wanted[3], chord = 0;
            set_rebuilt(2.0 * codes[0][k] / 255 - 1, 2.0 * codes[3][k] / 255 - 1, found);
            set_rebuilt(static_cast<double>(texel[0]), static_cast<double>(texel[1]), wanted);
            for (int c = 0; c < 3; ++c) chord += (found[c] - wanted[c]) * (found[c] - wanted[c]);
            sum += 2 * std::asin(std::min(1.0, 0.5 * std::sqrt(chord)));
        }
    }
    return sum * 180 / 3.14159265358979 / (extent.width * extent.height);
}

TEST(EncodeUastcXy, WritesWhatTheDecoderReads) {
    std::mt19937 random(2);
    for (int n = 0; n < 3000; ++n) {
        UastcContent content;
        content.mode = 15 + n % 3;
        content.second_channel = 1;
        content.pattern = static_cast<unsigned>(random()) % uastc_patterns(content.mode);
        content.hints.eac = static_cast<std::uint8_t>(16 + random() % 240);
        for (auto& subset : content.ends) {
            for (auto& end : subset) {
                for (std::uint8_t& number : end) number = static_cast<std::uint8_t>(random() % 256);
            }
        }
        const unsigned levels = 1u << kUastcModeTable[content.mode].weight_bits;
        for (auto& plane : content.weights) {
            for (std::uint8_t& weight : plane) weight = static_cast<std::uint8_t>(random() % levels);
        }
        std::byte block[16];
        write_uastc(content, block);
        std::uint8_t codes[4][16], made[3][16];
        decode_uastc(block, codes);
        uastc_texels(content, made);
        for (int c = 0; c < 3; ++c) EXPECT_TRUE(std::equal(made[0], made[0] + 16, codes[c]));
        ASSERT_TRUE(std::equal(made[1], made[1] + 16, codes[3])) << "mode " << content.mode;
    }
}

// fast, normal, best; the limits are what was measured, and a little more.
TEST(EncodeUastcXy, MoreEffortComesNearer) {
    const Extent extent{131, 62};
    for (const double steepness : {0.45, 2.0}) {
        const std::vector<float> texels = xy_bumps(extent, steepness);
        double before = steepness > 1 ? 2.8 : 1.6;
        for (const Effort effort : kXyEfforts) {
            const double angle = xy_angle(xy_blocks(effort, texels, extent), texels, extent);
            EXPECT_LT(angle, before);
            before = angle;
        }
    }
}

TEST(EncodeUastcXy, EveryInstructionSetGivesTheSameBytes) {
    const Extent extent{131, 37};
    const std::vector<float> texels = xy_bumps(extent, 0.8);
    for (const Effort effort : kXyEfforts) {
        const std::vector<std::byte> expected = xy_blocks(effort, texels, extent);
        on_every_target([&] { EXPECT_EQ(xy_blocks(effort, texels, extent), expected); });
    }
}

TEST(EncodeUastcXy, ABlockDependsOnItsTexelsAlone) {
    const Extent extent{72, 24};
    const std::vector<float> texels = xy_bumps(extent, 0.8);
    for (const Effort effort : kXyEfforts) {
        const std::vector<std::byte> all = xy_blocks(effort, texels, extent);
        for (int n = 0; n < extent.width / 4 * (extent.height / 4); ++n) {
            std::vector<float> block;
            for (int k = 0; k < 16; ++k) {
                const int i = n % (extent.width / 4) * 4 + k % 4, j = n / (extent.width / 4) * 4 + k / 4;
                const auto from = texels.begin() + 2 * (j * extent.width + i);
                block.insert(block.end(), from, from + 2);
            }
            const std::vector<std::byte> alone = xy_blocks(effort, block, {4, 4});
            ASSERT_TRUE(std::equal(alone.begin(), alone.end(), all.begin() + 16 * n)) << "block " << n;
        }
    }
}

// One normal is one colour, exact but for its codes; what is longer than 1 is clamped, and NaN is no crash.
TEST(EncodeUastcXy, FlatBlocksAndBrokenVectorsAreEncoded) {
    const float vectors[][2] = {{0, 0}, {1, 0}, {0, -1}, {0.137f, 0.211f}, {1, 1}, {-7, 0}, {std::nanf(""), 0}};
    for (const auto& vector : vectors) {
        std::vector<float> texels;
        for (int k = 0; k < 16; ++k) texels.insert(texels.end(), vector, vector + 2);
        for (const Effort effort : kXyEfforts) {
            const std::vector<std::byte> block = xy_blocks(effort, texels, {4, 4});
            EXPECT_EQ(std::to_integer<unsigned>(block[0]) & 31u, 0x17u) << "mode 8";
            if (!(std::fabs(vector[0]) + std::fabs(vector[1]) < 1)) continue;
            EXPECT_LT(xy_angle(block, texels, {4, 4}), 0.35);
        }
        texels[0] = texels[9] = 0.4f;
        for (const Effort effort : kXyEfforts) xy_blocks(effort, texels, {4, 4});
    }
}

// The squared error of what a transcoder makes of alpha as EAC, as Basis Universal describes it.
int eac_error_of(const std::uint8_t alpha[16], int hint) {
    const int* const modifiers = kEacModifiers[hint % 16];
    const int low = *std::min_element(alpha, alpha + 16), high = *std::max_element(alpha, alpha + 16);
    const float part = static_cast<float>(-modifiers[3]) / static_cast<float>(modifiers[7] - modifiers[3]);
    const int center = static_cast<int>(std::round(static_cast<float>(low) + static_cast<float>(high - low) * part));
    int sum = 0;
    for (int k = 0; k < 16; ++k) {
        int nearest = 255;
        for (int s = 0; s < 8; ++s)
            nearest = std::min(nearest, std::abs(std::clamp(center + modifiers[s] * (hint / 16), 0, 255) - alpha[k]));
        sum += nearest * nearest;
    }
    return sum;
}

TEST(EncodeUastcXy, HintsForAlphaAreTheBestOnes) {
    std::mt19937 random(3);
    for (int n = 0; n < 200; ++n) {
        std::uint8_t grey[16], alpha[16];
        const int range = 2 + n, first = static_cast<int>(random() % static_cast<unsigned>(256 - range));
        for (int k = 0; k < 16; ++k) {
            grey[k] = static_cast<std::uint8_t>(random() % 256);
            alpha[k] = static_cast<std::uint8_t>(first + static_cast<int>(random() % static_cast<unsigned>(range)));
        }
        alpha[0] = static_cast<std::uint8_t>(first);
        alpha[5] = static_cast<std::uint8_t>(first + 1);
        int best = 1 << 30;
        for (int hint = 16; hint < 256; ++hint) best = std::min(best, eac_error_of(alpha, hint));
        UastcHints hints;
        find_uastc_xy_hints(Effort::best, grey, alpha, hints);
        EXPECT_EQ(eac_error_of(alpha, hints.eac), best);
        UastcHints fast;
        find_uastc_xy_hints(Effort::fast, grey, alpha, fast);
        EXPECT_GE(fast.eac, 16) << "a multiplier of 0 is not legal";
    }
}

}  // namespace
}  // namespace tex
