// SPDX-License-Identifier: Apache-2.0
// The encoder of BC7: what it writes is what the decoder gives; no block depends on its neighbours or the instruction
// set; and how near the directions come.

#include "kernels/encode_bc7.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "blocks/bc7.h"
#include "blocks/bc7_modes.h"
#include "blocks/bc7_write.h"
#include "blocks/bptc.h"
#include "unit/targets.h"

namespace tex {
namespace {

constexpr Effort kBc7Efforts[] = {Effort::fast, Effort::normal, Effort::best};

std::size_t place_of(int n) { return static_cast<std::size_t>(n); }

// Waves, edges and noise. `alpha`: waves beside them in some blocks, else 1.
std::vector<float> bumps(Extent extent, bool alpha, float least_z) {
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
            const bool has_data = alpha && i / 16 % 3 != 0;
            texels.push_back(has_data ? static_cast<float>(0.5 + 0.4 * std::sin(0.11 * i - 0.05 * j)) : 1.0f);
        }
    }
    return texels;
}

std::vector<std::byte> encoded(Effort effort, const std::vector<float>& texels, Extent extent) {
    std::vector<std::byte> blocks(level_bytes(Format::bc7_unorm, extent));
    encode_bc7(Format::bc7_unorm, effort, texels.data(), extent, blocks.data());
    return blocks;
}

struct Bc7Errors {
    double angle = 0;  // the mean, in degrees
    double alpha = 0;  // root mean square, in codes
    int least_alpha = 255;
};

Bc7Errors errors_of(const std::vector<std::byte>& blocks, const std::vector<float>& texels, Extent extent) {
    const int across = (extent.width + 3) / 4;
    Bc7Errors errors;
    for (int n = 0; n < static_cast<int>(blocks.size() / 16); ++n) {
        std::uint8_t rgba[16][4];
        decode_bc7(&blocks[place_of(16 * n)], rgba);
        for (int k = 0; k < 16; ++k) {
            const int i = n % across * 4 + k % 4, j = n / across * 4 + k / 4;
            if (i >= extent.width || j >= extent.height) continue;
            const float* const texel = &texels[4 * place_of(j * extent.width + i)];
            double v[3], along = 0, squared = 0;
            for (int c = 0; c < 3; ++c) {
                v[c] = 2.0 * rgba[k][c] / 255.0 - 1.0;
                along += v[c] * texel[c];
                squared += v[c] * v[c];
            }
            errors.angle += std::acos(std::min(1.0, along / std::sqrt(squared)));
            errors.alpha += (rgba[k][3] - 255.0 * texel[3]) * (rgba[k][3] - 255.0 * texel[3]);
            errors.least_alpha = std::min<int>(errors.least_alpha, rgba[k][3]);
        }
    }
    const double texels_of_it = extent.width * extent.height;
    errors.angle *= 180.0 / 3.14159265358979 / texels_of_it;
    errors.alpha = std::sqrt(errors.alpha / texels_of_it);
    return errors;
}

// Contents of every mode, at random, with indices in the bits that the mode has for them.
TEST(EncodeBc7, WritesWhatTheDecoderReads) {
    std::mt19937 random(2);
    for (int n = 0; n < 8000; ++n) {
        Bc7Content content = {};
        content.mode = n % 8;
        const Bc7Mode& mode = kBc7Modes[content.mode];
        content.partition = static_cast<unsigned>(random() % (1u << mode.partition));
        content.rotation = static_cast<unsigned>(random() % (1u << mode.rotation));
        content.is_exchanged = mode.selection != 0 && random() % 2 == 0;
        const int more = mode.own_p + mode.shared_p;
        const auto width_of = [&](int c) { return c < 3 ? mode.color + more : mode.alpha + (mode.alpha ? more : 0); };
        for (auto& subset : content.ends) {
            const unsigned shared = static_cast<unsigned>(random() % 2);
            for (auto& end : subset) {
                const unsigned lowest = mode.shared_p != 0 ? shared : static_cast<unsigned>(random() % 2);
                for (int c = 0; c < 4; ++c) {
                    const unsigned code = static_cast<unsigned>(random() % (1u << width_of(c)));
                    end[c] = static_cast<std::uint8_t>(more != 0 && width_of(c) > 0 ? (code & ~1u) | lowest : code);
                }
            }
        }
        const int color = content.is_exchanged ? mode.second_index : mode.index;
        const int alpha = content.is_exchanged ? mode.index : mode.second_index;
        for (int k = 0; k < 16; ++k) {
            content.color[k] = static_cast<std::uint8_t>(random() % (1u << color));
            content.alpha[k] = static_cast<std::uint8_t>(random() % (1u << alpha));
        }
        std::byte block[16];
        write_bc7(content, block);
        std::uint8_t rgba[16][4];
        decode_bc7(block, rgba);
        for (unsigned k = 0; k < 16; ++k) {
            const unsigned subset = bptc_subset(mode.subsets, content.partition, k);
            int expected[4];
            for (int c = 0; c < 4; ++c) {
                const bool apart = c == 3 && mode.second_index != 0;
                const int bits = apart ? alpha : color, last = (1 << bits) - 1;
                const int weight = (128 * (apart ? content.alpha[k] : content.color[k]) + last) / (2 * last);
                const auto widened = [&](int e) {
                    const int high = content.ends[subset][e][c] << (8 - width_of(c));
                    return width_of(c) == 0 ? 255 : high | high >> width_of(c);
                };
                expected[c] = bptc_between(widened(0), widened(1), weight);
            }
            if (content.rotation != 0) std::swap(expected[3], expected[content.rotation - 1]);
            for (int c = 0; c < 4; ++c) ASSERT_EQ(rgba[k][c], expected[c]) << "mode " << content.mode << " texel " << k;
        }
    }
}

TEST(EncodeBc7, EveryInstructionSetGivesTheSameBytes) {
    const Extent extent{131, 37};
    for (const bool alpha : {false, true}) {
        const std::vector<float> texels = bumps(extent, alpha, 0.4f);
        for (const Effort effort : kBc7Efforts) {
            const std::vector<std::byte> expected = encoded(effort, texels, extent);
            on_every_target([&] { EXPECT_EQ(encoded(effort, texels, extent), expected); });
        }
    }
}

// Each row of blocks alone, and each block alone.
TEST(EncodeBc7, ABlockDependsOnItsTexelsAlone) {
    const Extent extent{72, 24};
    const std::vector<float> texels = bumps(extent, true, 0.4f);
    for (const Effort effort : kBc7Efforts) {
        const std::vector<std::byte> all = encoded(effort, texels, extent);
        for (int n = 0; n < extent.width / 4 * (extent.height / 4); ++n) {
            std::vector<float> block;
            for (int k = 0; k < 16; ++k) {
                const int i = n % (extent.width / 4) * 4 + k % 4, j = n / (extent.width / 4) * 4 + k / 4;
                const auto from = texels.begin() + 4 * (j * extent.width + i);
                block.insert(block.end(), from, from + 4);
            }
            const std::vector<std::byte> alone = encoded(effort, block, {4, 4});
            ASSERT_TRUE(std::equal(alone.begin(), alone.end(), all.begin() + 16 * n)) << "block " << n;
        }
    }
}

TEST(EncodeBc7, MoreEffortComesNearer) {
    const Extent extent{128, 128};
    const std::vector<float> texels = bumps(extent, false, 0.4f);
    double before = 1.35;  // a limit for fast
    for (const Effort effort : kBc7Efforts) {
        const Bc7Errors errors = errors_of(encoded(effort, texels, extent), texels, extent);
        EXPECT_LT(errors.angle, before);
        EXPECT_EQ(errors.least_alpha, 255) << "nothing is beside the normals";
        before = errors.angle;
    }
}

TEST(EncodeBc7, KeepsDataInAlpha) {
    const Extent extent{128, 128};
    const std::vector<float> texels = bumps(extent, true, 0.4f);
    for (const Effort effort : kBc7Efforts) {
        const Bc7Errors errors = errors_of(encoded(effort, texels, extent), texels, extent);
        EXPECT_LT(errors.angle, 2.2);
        EXPECT_LT(errors.alpha, 4.0);
    }
}

// Object space has normals in all directions.
TEST(EncodeBc7, TakesAnyDirection) {
    const Extent extent{128, 128};
    const std::vector<float> texels = bumps(extent, false, -1.0f);
    for (const Effort effort : kBc7Efforts)
        EXPECT_LT(errors_of(encoded(effort, texels, extent), texels, extent).angle, 2.5);
}

TEST(EncodeBc7, FlatBlocksAndBrokenVectorsAreEncoded) {
    const float vectors[][4] = {{0, 0, 1, 1}, {1, 0, 0, 1}, {0, -1, 0, 1}, {0, 0, 0, 1}, {0, 0, -1, 0.25f}};
    for (const auto& vector : vectors) {
        std::vector<float> texels;
        for (int k = 0; k < 16; ++k) texels.insert(texels.end(), vector, vector + 4);
        for (const Effort effort : kBc7Efforts) {
            const std::vector<std::byte> block = encoded(effort, texels, {4, 4});
            if (vector[0] + vector[1] + vector[2] == 0) continue;  // any direction is as good
            EXPECT_LT(errors_of(block, texels, {4, 4}).angle, 0.4);
        }
    }
}

// Doom 3 takes x from alpha. Red is 255.
TEST(EncodeBc7, RedAndAlphaAreExchanged) {
    const Extent extent{131, 62};
    const std::vector<float> texels = bumps(extent, false, 0.4f);
    double before = 1.6;  // a limit for fast
    for (const Effort effort : kBc7Efforts) {
        std::vector<std::byte> blocks(level_bytes(Format::bc7_unorm, extent));
        encode_bc7_rxgb(Format::bc7_unorm, effort, texels.data(), extent, blocks.data());
        const int across = (extent.width + 3) / 4;
        double sum = 0;
        int least_red = 255;
        for (int n = 0; n < static_cast<int>(blocks.size() / 16); ++n) {
            std::uint8_t rgba[16][4];
            decode_bc7(&blocks[place_of(16 * n)], rgba);
            for (int k = 0; k < 16; ++k) {
                const int i = n % across * 4 + k % 4, j = n / across * 4 + k / 4;
                least_red = std::min<int>(least_red, rgba[k][0]);
                if (i >= extent.width || j >= extent.height) continue;
                const float* const texel = &texels[4 * place_of(j * extent.width + i)];
                double along = 0, squared = 0;
                for (int c = 0; c < 3; ++c) {
                    const double v = 2.0 * rgba[k][c == 0 ? 3 : c] / 255.0 - 1.0;
                    along += v * texel[c];
                    squared += v * v;
                }
                sum += std::acos(std::min(1.0, along / std::sqrt(squared)));
            }
        }
        const double angle = sum * 180.0 / 3.14159265358979 / (extent.width * extent.height);
        EXPECT_LT(angle, before);
        before = angle;
        EXPECT_EQ(least_red, 255);
    }
}

}  // namespace
}  // namespace tex
