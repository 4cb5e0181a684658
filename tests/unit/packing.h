// SPDX-License-Identifier: Apache-2.0
// packing.h: normal maps to pack, and blocks as codes, for the tests of pack().

#pragma once

#include <cmath>
#include <cstddef>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tex/pack.h>

#include "blocks/bc1.h"
#include "blocks/bc4.h"
#include "blocks/eac.h"

namespace packing {

using tex::Encoding;
using tex::Extent;
using tex::MipChain;
using tex::NormalMap;

// Unit vectors around slowly turning directions, with some noise: smooth, rough and steep blocks.
inline NormalMap bumpy(Extent extent, unsigned seed) {
    NormalMap map(extent);
    std::mt19937 random(seed);
    const auto noise = [&] { return static_cast<float>(random() % 2001) / 1000.0f - 1.0f; };
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const float amount = 0.02f * static_cast<float>(i / 8 % 6);
            const float u = std::sin(0.07f * static_cast<float>(i)) * 0.8f + amount * noise();
            const float v = std::cos(0.05f * static_cast<float>(i + 2 * j)) * 0.9f + amount * noise();
            const float length = std::sqrt(u * u + v * v + 1.0f);
            map.x.at(i, j) = u / length;
            map.y.at(i, j) = v / length;
            map.z.at(i, j) = 1.0f / length;
        }
    }
    return map;
}

inline MipChain chain_of(NormalMap map) {
    MipChain chain;
    chain.levels.push_back(std::move(map));
    return chain;
}

inline std::vector<std::byte> pack_bytes(const MipChain& chain, const tex::PackOptions& options, int threads = 1) {
    tex::Execution execution;
    execution.threads = threads;
    const tex::Result<tex::PackedTexture> texture = tex::pack(chain, options, execution);
    EXPECT_TRUE(texture);
    std::vector<std::byte> bytes;
    for (const tex::Level& level : texture->levels) bytes.insert(bytes.end(), level.bytes.begin(), level.bytes.end());
    return bytes;
}

// The texels of one decoded block of BC3, BC5 or EAC, as codes of 8 bits, not rounded: first x, then y.
inline void decode_codes(const std::byte* block, Encoding encoding, float x[16], float y[16]) {
    float r[16], b[16], a[16];
    if (encoding == Encoding::dxt5nm) {
        tex::decode_bc4_unorm(block, x);
        tex::decode_bc1(block + 8, tex::Bc1Mode::four_colors, r, y, b, a);
    } else if (encoding == Encoding::bc5) {
        tex::decode_bc4_unorm(block, x);
        tex::decode_bc4_unorm(block + 8, y);
    } else if (encoding == Encoding::eac_rg11) {
        tex::decode_eac_unorm(block, x);
        tex::decode_eac_unorm(block + 8, y);
    } else {
        const auto decode = encoding == Encoding::bc5_snorm ? tex::decode_bc4_snorm : tex::decode_eac_snorm;
        decode(block, x);
        decode(block + 8, y);
        for (int k = 0; k < 16; ++k) {
            x[k] = (x[k] + 1) / 2;
            y[k] = (y[k] + 1) / 2;
        }
    }
    for (int k = 0; k < 16; ++k) {
        x[k] *= 255;
        y[k] *= 255;
    }
}

}  // namespace packing
