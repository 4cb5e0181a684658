// SPDX-License-Identifier: Apache-2.0
// The decoder of ASTC beside libastcenc, bit for bit, on random blocks of every size, and integer sequences there and
// back.

#include "blocks/astc_decode.h"

#include <array>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "blocks/astc_ise.h"
#include "unit/astcenc.h"

namespace tex {
namespace {

using Block = std::array<std::byte, 16>;

std::size_t index(int n) { return static_cast<std::size_t>(n); }

// The valid modes of weights for a size.
std::vector<unsigned> valid_modes(Extent block) {
    std::vector<unsigned> modes;
    for (unsigned bits = 0; bits < 1u << kAstcModeBits; ++bits) {
        if ((bits & 0x1ff) != kAstcVoid && astc_mode(bits, block)) modes.push_back(bits);
    }
    return modes;
}

// Any bits; bits with a valid mode, with one partition, or with up to three that have one mode of endpoints; blocks of
// one colour, of which many are valid.
Block random_block(std::mt19937_64& random, const std::vector<unsigned>& modes) {
    AstcBits bits{random(), random()};
    const auto set = [&bits](int at, int count, std::uint64_t value) {
        bits.low = (bits.low & ~(((std::uint64_t{1} << count) - 1) << at)) | value << at;
    };
    const auto kind = random() % 8;
    if (kind == 0) {
        set(0, 9, kAstcVoid);
        set(9, 3, random() % 2 == 0 ? 6 : random() % 8);
        if (random() % 2 == 0) bits.low |= ~std::uint64_t{0} << 12;
    }
    if (kind > 1) set(0, kAstcModeBits, modes[random() % modes.size()]);
    if (kind > 4) set(11, 2, 0);
    if (kind == 3 || kind == 4) {
        set(11, 2, 1 + random() % 2);
        set(23, 2, 0);
    }
    Block block;
    write_astc_bits(bits, block.data());
    return block;
}

// A row of blocks as libastcenc decodes it; NaN is its mark of errors. Version 4.2 gives partitions of high range the
// code 0xff00, which is not 1, for magenta; later versions give the specification's.
std::vector<float> judged(Extent block, const std::vector<Block>& blocks) {
    const Extent extent{static_cast<int>(blocks.size()) * block.width, block.height};
    std::vector<float> rgba = Astcenc(block).decode(blocks.front().data(), 16 * blocks.size(), extent);
    constexpr float kMagenta[4] = {1.0f, 0.0f, 1.0f, 1.0f};
    constexpr float kOld = 65280.0f / 65536.0f;
    for (std::size_t k = 0; k < rgba.size(); k += 4) {
        float* const texel = &rgba[k];
        const bool is_old = texel[0] == kOld && texel[1] == 0.0f && texel[2] == kOld && texel[3] == kOld;
        if (std::isnan(texel[0]) || is_old) std::memcpy(texel, kMagenta, sizeof kMagenta);
    }
    return rgba;
}

TEST(AstcDecode, IsThatOfLibastcencOnRandomBlocksOfEverySize) {
    constexpr int kBlocks = 7200;  // of each of 14 sizes
    for (const auto& row : kFormatNames) {
        const Extent block = format_info(row.value).block;
        if (row.value < Format::astc_4x4_unorm || row.value > Format::astc_12x12_unorm) continue;
        const std::vector<unsigned> modes = valid_modes(block);
        std::mt19937_64 random(static_cast<std::uint64_t>(block.width * 100 + block.height));
        std::vector<Block> blocks(kBlocks);
        for (Block& one : blocks) one = random_block(random, modes);
        const std::vector<float> theirs = judged(block, blocks);
        std::vector<float> ours(4 * kAstcMostTexels);
        AstcTexels texels;
        for (int c = 0; c < 4; ++c) texels.channel[c] = &ours[index(c * kAstcMostTexels)];
        int wrong = 0;
        for (int n = 0; n < kBlocks; ++n) {
            decode_astc(block, blocks[index(n)].data(), texels);
            for (int k = 0; k < 4 * block.width * block.height; ++k) {
                const int texel = k / 4, i = texel % block.width, j = texel / block.width;
                const float a = texels.channel[k % 4][texel];
                const float b = theirs[4 * index((j * kBlocks + n) * block.width + i) + index(k % 4)];
                if (std::memcmp(&a, &b, sizeof a) != 0) ++wrong;
            }
        }
        EXPECT_EQ(wrong, 0) << row.name;
    }
}

TEST(AstcDecode, SkipsChannelsThatNobodyNeeds) {
    const Extent extent{5, 4};
    std::mt19937_64 random(1);
    const std::vector<unsigned> modes = valid_modes(extent);
    for (int n = 0; n < 100; ++n) {
        const Block block = random_block(random, modes);
        float all[4][20], alpha[20];
        decode_astc(extent, block.data(), {{all[0], all[1], all[2], all[3]}});
        decode_astc(extent, block.data(), {{nullptr, nullptr, nullptr, alpha}});
        EXPECT_EQ(std::memcmp(all[3], alpha, sizeof alpha), 0);
    }
}

TEST(AstcIse, SequencesComeBack) {
    std::mt19937 random(2);
    for (int range = 0; range < kAstcRanges; ++range) {
        for (int count = 1; count <= 64 && astc_ise_bits(range, count) <= 100; ++count) {
            std::uint8_t values[64], again[64];
            for (int k = 0; k < count; ++k) {
                values[k] = static_cast<std::uint8_t>(random() % static_cast<unsigned>(kAstcRangeTable[range].levels));
            }
            AstcBits bits;
            write_astc_ise(bits, 17, range, count, values);
            const int end = 17 + astc_ise_bits(range, count);
            read_astc_ise(bits, 17, range, count, again);
            EXPECT_EQ(std::memcmp(values, again, index(count)), 0) << range << " " << count;
            EXPECT_EQ(bits.at(end, 11), 0u) << "writes beyond its end";
        }
    }
}

}  // namespace
}  // namespace tex
