// SPDX-License-Identifier: Apache-2.0
// The encoder of UASTC: what it writes is what the decoder gives; no block depends on its neighbours or the instruction
// set; how near the directions come; and that hints are the best ones for a transcoder that is written here.

#include "kernels/encode_uastc.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "blocks/astc_ise.h"
#include "blocks/uastc.h"
#include "blocks/uastc_modes.h"
#include "blocks/uastc_write.h"
#include "kernels/bc7_guess.h"
#include "kernels/uastc_hints.h"
#include "unit/targets.h"

namespace tex {
namespace {

constexpr Effort kUastcEfforts[] = {Effort::fast, Effort::normal, Effort::best};

std::size_t uastc_place(int n) { return static_cast<std::size_t>(n); }

// Waves, edges and noise.
std::vector<float> uastc_bumps(Extent extent, float least_z) {
    std::mt19937 random(5);
    std::vector<float> texels;
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const double noise = static_cast<double>(random() % 1000) / 1000 - 0.5;
            const double x = 0.5 * std::sin(0.2 * i + 0.1 * j) + (i > extent.width / 2 ? 0.3 : 0.004) * noise;
            const double y = (i + 2 * j) % 40 < 20 ? 0.3 : -0.45 * std::cos(0.07 * i);
            const double z = least_z + 0.5 * (1 - least_z) * (1 + std::cos(0.05 * j));
            const double length = std::sqrt(x * x + y * y + z * z);
            for (const double v : {x, y, z}) texels.push_back(static_cast<float>(v / length));
        }
    }
    return texels;
}

std::vector<std::byte> uastc_of(Effort effort, const std::vector<float>& texels, Extent extent) {
    std::vector<std::byte> blocks(level_bytes(Format::uastc_4x4_unorm, extent));
    encode_uastc(Format::uastc_4x4_unorm, effort, texels.data(), extent, blocks.data());
    return blocks;
}

// The mean angle in degrees. Alpha is 255 everywhere.
double uastc_angle(const std::vector<std::byte>& blocks, const std::vector<float>& texels, Extent extent) {
    const int across = (extent.width + 3) / 4;
    double sum = 0;
    for (int n = 0; n < static_cast<int>(blocks.size() / 16); ++n) {
        std::uint8_t codes[4][16];
        decode_uastc(&blocks[uastc_place(16 * n)], codes);
        for (int k = 0; k < 16; ++k) {
            EXPECT_EQ(codes[3][k], 255);
            const int i = n % across * 4 + k % 4, j = n / across * 4 + k / 4;
            if (i >= extent.width || j >= extent.height) continue;
            const float* const texel = &texels[3 * uastc_place(j * extent.width + i)];
            double along = 0, squared = 0, wanted = 0;
            for (int c = 0; c < 3; ++c) {
                const double v = 2.0 * codes[c][k] / 255.0 - 1.0, t = texel[c];
                along += v * t;
                squared += v * v;
                wanted += t * t;
            }
            sum += std::acos(std::min(1.0, along / std::sqrt(squared * wanted)));
        }
    }
    return sum * 180.0 / 3.14159265358979 / (extent.width * extent.height);
}

// Contents of every mode of RGB, at random.
TEST(EncodeUastc, WritesWhatTheDecoderReads) {
    constexpr int kModes[] = {0, 1, 2, 3, 4, 5, 6, 7, 18};
    std::mt19937 random(2);
    for (int n = 0; n < 4500; ++n) {
        UastcContent content;
        content.mode = kModes[n % 9];
        const UastcMode& mode = kUastcModeTable[content.mode];
        content.pattern = static_cast<unsigned>(random()) % uastc_patterns(content.mode);
        content.second_channel = static_cast<unsigned>(random() % 3);
        content.hints.flip = random() % 2 == 0;
        content.hints.bias = static_cast<std::uint8_t>(random() % 32);
        const auto levels = static_cast<unsigned>(kAstcRangeTable[mode.color_range].levels);
        for (auto& subset : content.ends) {
            for (auto& end : subset) {
                for (std::uint8_t& number : end) number = static_cast<std::uint8_t>(random() % levels);
            }
        }
        for (auto& plane : content.weights) {
            for (std::uint8_t& weight : plane) weight = static_cast<std::uint8_t>(random() % (1u << mode.weight_bits));
        }
        std::byte block[16];
        write_uastc(content, block);
        std::uint8_t codes[4][16], made[3][16];
        decode_uastc(block, codes);
        uastc_texels(content, made);
        for (int c = 0; c < 3; ++c) EXPECT_TRUE(std::equal(made[c], made[c] + 16, codes[c]));
        const UastcPattern& pattern = *uastc_pattern(content.mode, content.pattern);
        for (int k = 0; k < 16; ++k) {
            for (unsigned c = 0; c < 3; ++c) {
                const int plane = mode.planes == 2 && c == content.second_channel ? 1 : 0;
                const int weight =
                    kAstcMeanings.weight[kUastcWeightRanges[mode.weight_bits]][content.weights[plane][k]];
                const auto& ends = content.ends[pattern.subset[k]];
                const int e0 = 257 * uastc_code(mode.color_range, ends[0][c]);
                const int e1 = 257 * uastc_code(mode.color_range, ends[1][c]);
                ASSERT_EQ(codes[c][k], (e0 * (64 - weight) + e1 * weight + 32) >> 14) << "mode " << content.mode;
            }
            ASSERT_EQ(codes[3][k], 255);
        }
    }
}

TEST(EncodeUastc, EveryInstructionSetGivesTheSameBytes) {
    const Extent extent{131, 37};
    const std::vector<float> texels = uastc_bumps(extent, 0.4f);
    for (const Effort effort : kUastcEfforts) {
        const std::vector<std::byte> expected = uastc_of(effort, texels, extent);
        on_every_target([&] { EXPECT_EQ(uastc_of(effort, texels, extent), expected); });
    }
}

TEST(EncodeUastc, ABlockDependsOnItsTexelsAlone) {
    const Extent extent{72, 24};
    const std::vector<float> texels = uastc_bumps(extent, 0.4f);
    for (const Effort effort : kUastcEfforts) {
        const std::vector<std::byte> all = uastc_of(effort, texels, extent);
        for (int n = 0; n < extent.width / 4 * (extent.height / 4); ++n) {
            std::vector<float> block;
            for (int k = 0; k < 16; ++k) {
                const int i = n % (extent.width / 4) * 4 + k % 4, j = n / (extent.width / 4) * 4 + k / 4;
                const auto from = texels.begin() + 3 * (j * extent.width + i);
                block.insert(block.end(), from, from + 3);
            }
            const std::vector<std::byte> alone = uastc_of(effort, block, {4, 4});
            ASSERT_TRUE(std::equal(alone.begin(), alone.end(), all.begin() + 16 * n)) << "block " << n;
        }
    }
}

TEST(EncodeUastc, MoreEffortComesNearer) {
    const Extent extent{128, 128};
    const std::vector<float> texels = uastc_bumps(extent, 0.4f);
    double before = 2.0;  // a limit for fast
    for (const Effort effort : kUastcEfforts) {
        const double angle = uastc_angle(uastc_of(effort, texels, extent), texels, extent);
        EXPECT_LT(angle, before);
        before = angle;
    }
}

// Object space has normals in all directions.
TEST(EncodeUastc, TakesAnyDirection) {
    const Extent extent{128, 128};
    const std::vector<float> texels = uastc_bumps(extent, -1.0f);
    for (const Effort effort : kUastcEfforts)
        EXPECT_LT(uastc_angle(uastc_of(effort, texels, extent), texels, extent), 3.2);
}

// A block of one direction is one colour, whose length is chosen: two codes beside the middle are 0.33 degrees off.
TEST(EncodeUastc, FlatBlocksAndBrokenVectorsAreEncoded) {
    const float vectors[][3] = {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}, {0.137f, 0.211f, 0.96784f}, {0, 0, 0}};
    for (const auto& vector : vectors) {
        std::vector<float> texels;
        for (int k = 0; k < 16; ++k) texels.insert(texels.end(), vector, vector + 3);
        for (const Effort effort : kUastcEfforts) {
            const std::vector<std::byte> block = uastc_of(effort, texels, {4, 4});
            EXPECT_EQ(std::to_integer<unsigned>(block[0]) & 31u, 0x17u) << "mode 8";
            if (vector[0] + vector[1] + vector[2] == 0) continue;  // any direction is as good
            const double off = std::fabs(vector[0] * vector[1]) > 0 ? 0.06 : 0.4;
            EXPECT_LT(uastc_angle(block, texels, {4, 4}), off);
        }
    }
}

// What a transcoder makes of a block as ETC1, as Basis Universal describes it: the mean of each half in 4 or 5 bits,
// moved by the bias; the modifier of the texel by luminance. Returns the sum of the cosines.
double cosines_as_etc1(const UastcHintGroup& group, int flip, int diff, const int tables[2], int bias) {
    constexpr int kModifiers[8][4] = {{-8, -2, 2, 8},       {-17, -5, 5, 17},    {-29, -9, 9, 29},
                                      {-42, -13, 13, 42},   {-60, -18, 18, 60},  {-80, -24, 24, 80},
                                      {-106, -33, 33, 106}, {-183, -47, 47, 183}};
    constexpr int kOne[][4] = {{2, 0, 0, -1},  {5, 0, 1, -1}, {6, 0, 2, -1},  {7, 0, 0, 1},
                               {11, 0, 1, 1},  {15, 0, 2, 1}, {18, 1, 0, -1}, {19, 1, 1, -1},
                               {20, 1, 2, -1}, {21, 1, 0, 1}, {24, 1, 1, 1},  {8, 1, 2, 1}};
    constexpr int kAll[][3] = {{10, -2, -2}, {27, -1, 0}, {28, 1, -1}, {29, 0, 1}, {30, 0, -1}, {31, 1, 0}};
    int moves[2][3];
    for (int half = 0; half < 2; ++half) {
        for (int c = 0, divisor = 1; c < 3; ++c, divisor *= 3) moves[half][c] = bias / divisor % 3 - 1;
    }
    for (const auto& row : kOne) {
        if (row[0] != bias) continue;
        for (auto& of_half : moves) std::fill_n(of_half, 3, 0);
        moves[row[1]][row[2]] = row[3];
    }
    for (const auto& row : kAll) {
        for (int half = 0; half < 2 && row[0] == bias; ++half) std::fill_n(moves[half], 3, row[1 + half]);
    }
    const int limit = diff != 0 ? 31 : 15;
    int base[2][3];
    const auto half_of = [&](int k) { return flip != 0 ? k / 8 : k % 4 / 2; };
    for (int c = 0; c < 3; ++c) {
        int code[2];
        for (int half = 0; half < 2; ++half) {
            int sum = 0;
            for (int k = 0; k < 16; ++k) sum += half_of(k) == half ? static_cast<int>(group.code[k][c][0]) : 0;
            const int mean = (sum * limit + 1020) / 2040, move = moves[half][c];
            code[half] = mean == 0 ? (move == -2 ? 3 : move + 1) : mean == limit ? mean + move - 1 : mean + move;
            if (code[half] < 0) code[half] = mean - move;
        }
        if (diff != 0) code[1] = code[0] + std::clamp(code[1] - code[0], -4, 3);
        for (int half = 0; half < 2; ++half)
            base[half][c] = diff != 0 ? code[half] << 3 | code[half] >> 2 : 17 * code[half];
    }
    double all = 0;
    for (int k = 0; k < 16; ++k) {
        const int half = half_of(k);
        int colors[4][3], light[4], its = 0;
        constexpr int kLight[3] = {54, 183, 19};
        for (int m = 0; m < 4; ++m) {
            light[m] = 0;
            for (int c = 0; c < 3; ++c) {
                colors[m][c] = std::clamp(base[half][c] + kModifiers[tables[half]][m], 0, 255);
                light[m] += kLight[c] * colors[m][c];
            }
        }
        for (int c = 0; c < 3; ++c) its += 2 * kLight[c] * static_cast<int>(group.code[k][c][0]);
        int m = 0;
        while (m < 3 && its >= light[m] + light[m + 1]) ++m;
        double along = 0, squared = 0;
        for (int c = 0; c < 3; ++c) {
            const double v = colors[m][c] - 127.5;
            along += v * static_cast<double>(group.value[k][c][0]);
            squared += v * v;
        }
        all += along / std::sqrt(squared);
    }
    return all;
}

TEST(EncodeUastc, HintsForEtc1AreTheBestOnes) {
    std::mt19937 random(7);
    for (int n = 0; n < 12; ++n) {
        UastcHintGroup group = {};
        const double slope = 0.05 + 0.1 * n, x0 = static_cast<double>(random() % 100) / 100 - 0.5;
        for (int k = 0; k < 16; ++k) {
            double v[3] = {x0 + slope * (k % 4) / 3, slope * (k / 4) / 3, 1}, squared = 0;
            for (double& c : v) c += 0.05 * (static_cast<double>(random() % 100) / 100 - 0.5);
            for (const double c : v) squared += c * c;
            for (int c = 0; c < 3; ++c) {
                const double unit = v[c] / std::sqrt(squared);
                for (int lane = 0; lane < kBc7Lanes; ++lane) {
                    group.value[k][c][lane] = static_cast<float>(unit);
                    group.code[k][c][lane] = static_cast<float>(std::floor(127.5 * unit + 128));
                }
            }
        }
        double best = -100;
        for (int way = 0; way < 4 * 32; ++way) {
            const int bias = way / 4;
            for (int tables = 0; tables < 64; ++tables) {
                const int both[2] = {tables % 8, tables / 8};
                best = std::max(best, cosines_as_etc1(group, way % 2, way / 2 % 2, both, bias));
            }
        }
        const auto found = [&](Effort effort) {
            find_etc1_hints(effort, group);
            const int tables[2] = {static_cast<int>(group.table[0][0]), static_cast<int>(group.table[1][0])};
            return cosines_as_etc1(group, static_cast<int>(group.flip[0]), static_cast<int>(group.diff[0]), tables,
                                   static_cast<int>(group.bias[0]));
        };
        const double fast = found(Effort::fast), normal = found(Effort::normal);
        EXPECT_NEAR(found(Effort::best), best, 1e-5);
        EXPECT_GE(normal, fast - 1e-5);
    }
}

}  // namespace
}  // namespace tex
