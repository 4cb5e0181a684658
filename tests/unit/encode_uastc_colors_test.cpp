// SPDX-License-Identifier: Apache-2.0
// UASTC of values that are no directions. How near they come is judged by references that are written here: the best
// block of all endpoints in one mode, and a plain fit in floating point; what transcoders make of it, by transcode().

#include "kernels/encode_uastc_colors.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <tex/pack.h>
#include <tex/transcode.h>

#include "blocks/uastc.h"

namespace tex {
namespace {

constexpr Effort kColorEfforts[] = {Effort::fast, Effort::normal, Effort::best};

std::size_t color_place(int n) { return static_cast<std::size_t>(n); }

// Whole codes of occlusion, roughness and metalness: soft shadows with an edge, grain, and patches of metal.
struct OrmMap {
    Extent extent;
    std::vector<float> rgb;
};
OrmMap orm_map(Extent extent, double grain) {
    OrmMap map{extent, {}};
    std::mt19937 random(11);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const double noise = static_cast<double>(random() % 1000) / 1000 - 0.5;
            const double occlusion = (i + 2 * j) % 37 < 3 ? 0.35 : 0.9 - 0.2 * std::sin(0.11 * i) * std::cos(0.07 * j);
            const bool is_metal = std::sin(0.13 * i + 0.4) + std::cos(0.17 * j) > 0.6;
            const double roughness = (is_metal ? 0.25 : 0.7) + 0.1 * std::sin(0.3 * i + 0.2 * j) + grain * noise;
            for (const double v : {occlusion, roughness, is_metal ? 0.98 : 0.02}) {
                const double code = std::floor(255 * std::clamp(v, 0.0, 1.0) + 0.5);
                map.rgb.push_back(static_cast<float>(code / 255));
            }
        }
    }
    return map;
}

std::vector<std::byte> color_blocks(Effort effort, const std::vector<float>& rgb, Extent extent) {
    std::vector<std::byte> blocks(level_bytes(Format::uastc_4x4_unorm, extent));
    encode_uastc_colors(Format::uastc_4x4_unorm, effort, rgb.data(), extent, blocks.data());
    return blocks;
}

// The mean squared error in codes, over R, G and B.
double color_error(const std::vector<std::byte>& blocks, const OrmMap& map) {
    const int across = (map.extent.width + 3) / 4;
    double sum = 0;
    for (int n = 0; n < static_cast<int>(blocks.size() / 16); ++n) {
        std::uint8_t codes[4][16];
        decode_uastc(&blocks[color_place(16 * n)], codes);
        for (int k = 0; k < 16; ++k) {
            EXPECT_EQ(codes[3][k], 255);
            const int i = n % across * 4 + k % 4, j = n / across * 4 + k / 4;
            if (i >= map.extent.width || j >= map.extent.height) continue;
            for (int c = 0; c < 3; ++c) {
                const float wanted = map.rgb[color_place(3 * (j * map.extent.width + i) + c)];
                const double off = codes[c][k] - 255 * static_cast<double>(wanted);
                sum += off * off;
            }
        }
    }
    return sum / (3.0 * map.extent.width * map.extent.height);
}

// What a plain encoder reaches: 16 even steps between the texels that are farthest apart, where nothing is rounded.
double plain_error(const OrmMap& map) {
    double sum = 0;
    for (int top = 0; top < map.extent.height; top += 4) {
        for (int left = 0; left < map.extent.width; left += 4) {
            std::vector<const float*> texels;
            for (int j = top; j < std::min(top + 4, map.extent.height); ++j) {
                for (int i = left; i < std::min(left + 4, map.extent.width); ++i)
                    texels.push_back(&map.rgb[color_place(3 * (j * map.extent.width + i))]);
            }
            const auto apart = [](const float* a, const float* b) {
                double squared = 0;
                for (int c = 0; c < 3; ++c) {
                    const double off = 255 * (static_cast<double>(a[c]) - static_cast<double>(b[c]));
                    squared += off * off;
                }
                return squared;
            };
            const float *first = texels[0], *last = texels[0];
            for (const float* a : texels) {
                for (const float* b : texels) {
                    if (apart(a, b) <= apart(first, last)) continue;
                    first = a;
                    last = b;
                }
            }
            for (const float* texel : texels) {
                double least = std::numeric_limits<double>::max();
                for (int step = 0; step < 16; ++step) {
                    const float w = static_cast<float>(step) / 15.0f;
                    float made[3];
                    for (int c = 0; c < 3; ++c) made[c] = first[c] + w * (last[c] - first[c]);
                    least = std::min(least, apart(made, texel));
                }
                sum += least;
            }
        }
    }
    return sum / (3.0 * map.extent.width * map.extent.height);
}

double psnr_of(double error) { return 10 * std::log10(255 * 255 / error); }

// The limits in decibels are what was measured, less a little.
TEST(EncodeUastcColors, MoreEffortComesNearerAndBeatsAPlainFit) {
    const struct { double grain, limits[3]; } cases[] = {{0.02, {42.5, 43.4, 44.3}}, {0.3, {36.0, 36.7, 36.9}}};
    for (const auto& [grain, limits] : cases) {
        const OrmMap map = orm_map({131, 62}, grain);
        double before = plain_error(map);
        const double plain = psnr_of(before);
        for (int n = 0; n < 3; ++n) {
            const double error = color_error(color_blocks(kColorEfforts[n], map.rgb, map.extent), map);
            EXPECT_LT(error, before);
            EXPECT_GT(psnr_of(error), plain + 3) << "grain " << grain << ", effort " << n;
            EXPECT_GT(psnr_of(error), limits[n]) << "grain " << grain << ", effort " << n;
            before = error;
        }
    }
}

// Grey blocks beside the best of all pairs of endpoints in mode 15: 256 levels, 16 weights.
TEST(EncodeUastcColors, GreyIsAsGoodAsTheBestEndpoints) {
    constexpr int kWeights[16] = {0, 4, 8, 12, 17, 21, 25, 29, 35, 39, 43, 47, 52, 56, 60, 64};
    std::mt19937 random(3);
    double reference = 0, found[3] = {};
    for (int n = 0; n < 12; ++n) {
        int codes[16];
        const int first = static_cast<int>(random() % 180), range = 5 + 6 * n;
        std::vector<float> rgb;
        for (int& code : codes) {
            code = std::min(255, first + static_cast<int>(random() % static_cast<unsigned>(range)));
            rgb.insert(rgb.end(), 3, static_cast<float>(code) / 255.0f);
        }
        int least = std::numeric_limits<int>::max();
        for (int e0 = 0; e0 < 256; ++e0) {
            for (int e1 = e0; e1 < 256; ++e1) {
                int sum = 0;
                for (int k = 0; k < 16 && sum < least; ++k) {
                    int nearest = 255;
                    for (const int w : kWeights)
                        nearest = std::min(nearest, std::abs(((257 * ((64 - w) * e0 + w * e1) + 32) >> 14) - codes[k]));
                    sum += nearest * nearest;
                }
                least = std::min(least, sum);
            }
        }
        reference += least;
        for (int e = 0; e < 3; ++e) {
            std::uint8_t decoded[4][16];
            decode_uastc(color_blocks(kColorEfforts[e], rgb, {4, 4}).data(), decoded);
            for (int k = 0; k < 16; ++k) {
                EXPECT_TRUE(decoded[0][k] == decoded[1][k] && decoded[1][k] == decoded[2][k]);
                found[e] += (decoded[0][k] - codes[k]) * (decoded[0][k] - codes[k]);
            }
        }
    }
    EXPECT_LT(found[0], 1.8 * reference);
    EXPECT_LT(found[1], 1.1 * reference);
    EXPECT_LE(found[2], 1.05 * reference);
}

// Constants that the range of every mode has, and blocks of one colour.
TEST(EncodeUastcColors, ConstantsComeBackExactly) {
    std::mt19937 random(7);
    for (int n = 0; n < 60; ++n) {
        std::vector<float> rgb;
        const float red = n % 2 == 0 ? 1.0f : 0.0f, blue = n % 3 == 0 ? 1.0f : 0.0f;
        for (int k = 0; k < 16; ++k) rgb.insert(rgb.end(), {red, static_cast<float>(random() % 256) / 255.0f, blue});
        for (const Effort effort : kColorEfforts) {
            std::uint8_t codes[4][16];
            decode_uastc(color_blocks(effort, rgb, {4, 4}).data(), codes);
            for (int k = 0; k < 16; ++k) {
                ASSERT_EQ(codes[0][k], n % 2 == 0 ? 255 : 0);
                ASSERT_EQ(codes[2][k], n % 3 == 0 ? 255 : 0);
            }
        }
        std::vector<float> one;
        for (int k = 0; k < 16; ++k) one.insert(one.end(), rgb.begin(), rgb.begin() + 3);
        std::uint8_t codes[4][16];
        decode_uastc(color_blocks(Effort::fast, one, {4, 4}).data(), codes);
        for (int k = 0; k < 16; ++k) {
            for (int c = 0; c < 3; ++c) ASSERT_EQ(codes[c][k], std::lround(255 * one[color_place(c)]));
        }
    }
}

TEST(EncodeUastcColors, ABlockDependsOnItsTexelsAloneAndBrokenValuesAreNoCrash) {
    const OrmMap map = orm_map({24, 12}, 0.1);
    for (const Effort effort : kColorEfforts) {
        const std::vector<std::byte> all = color_blocks(effort, map.rgb, map.extent);
        for (int n = 0; n < 18; ++n) {
            std::vector<float> block;
            for (int k = 0; k < 16; ++k) {
                const int i = n % 6 * 4 + k % 4, j = n / 6 * 4 + k / 4;
                const auto from = map.rgb.begin() + 3 * (j * 24 + i);
                block.insert(block.end(), from, from + 3);
            }
            const std::vector<std::byte> alone = color_blocks(effort, block, {4, 4});
            ASSERT_TRUE(std::equal(alone.begin(), alone.end(), all.begin() + 16 * n)) << "block " << n;
        }
        std::vector<float> broken(48, 0.5f);
        broken[0] = std::nanf("");
        broken[7] = -3.0f;
        broken[13] = std::numeric_limits<float>::infinity();
        std::uint8_t codes[4][16];
        decode_uastc(color_blocks(effort, broken, {4, 4}).data(), codes);
        EXPECT_LE(codes[1][2], 20);
        EXPECT_GE(codes[1][4], 235);
    }
}

// What a GPU reads: ASTC and BC7 lose little; BC1 has four colours, and ETC1 four greys on one of two. The limits are
// what was measured, less a little.
TEST(EncodeUastcColors, HintsSuitTranscoders) {
    const OrmMap map = orm_map({128, 64}, 0.05);
    for (const Effort effort : kColorEfforts) {
        Texture texture;
        texture.format = Format::uastc_4x4_unorm;
        texture.swizzle = {Component::other, Component::other, Component::other, Component::one};
        texture.levels.push_back({map.extent, color_blocks(effort, map.rgb, map.extent)});
        const std::pair<GpuFormat, double> limits[] = {
            {GpuFormat::astc, 41.0}, {GpuFormat::bc7, 40.0}, {GpuFormat::bc1, 28.8}, {GpuFormat::etc1, 19.5}};
        for (const auto& [format, limit] : limits) {
            const auto shown = transcode(texture, format);
            ASSERT_TRUE(shown) << shown.error().message();
            const auto image = decode(*shown, 0);
            ASSERT_TRUE(image);
            double sum = 0;
            for (int j = 0; j < map.extent.height; ++j) {
                for (int i = 0; i < map.extent.width; ++i) {
                    for (int c = 0; c < 3; ++c) {
                        const double wanted = map.rgb[color_place(3 * (j * map.extent.width + i) + c)];
                        const double off = 255 * (static_cast<double>(image->planes[color_place(c)].at(i, j)) - wanted);
                        sum += off * off;
                    }
                }
            }
            EXPECT_GT(psnr_of(sum / (3.0 * map.extent.width * map.extent.height)), limit)
                << name_of(kGpuFormatNames, format);
        }
    }
}

}  // namespace
}  // namespace tex
