// SPDX-License-Identifier: Apache-2.0

#include "formats/exr/exr_zip.h"

#include <zlib.h>

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace tex {
namespace {

using Bytes = std::vector<std::byte>;

Bytes deflated(std::size_t size) {
    const std::vector<unsigned char> zeros(size);
    Bytes bytes(compressBound(size));
    uLongf length = bytes.size();
    compress(reinterpret_cast<Bytef*>(bytes.data()), &length, zeros.data(), size);
    bytes.resize(length);
    return bytes;
}

TEST(ExrZip, ChunksHoldAllTexelsOrNone) {
    Unzipper unzipper;
    const Bytes chunk = deflated(100'000);
    const std::span<const std::byte> bytes(chunk);
    EXPECT_EQ(unzipper.texels(bytes, 100'000, 100'000).size(), 100'000u);
    EXPECT_EQ(unzipper.texels(bytes, 99'999, 100'000).size(), 99'999u);
    EXPECT_TRUE(unzipper.texels(bytes, 100'001, 200'000).empty());
    EXPECT_TRUE(unzipper.texels(bytes, 99'999, 99'999).empty()) << "more than a chunk can hold";
    EXPECT_TRUE(unzipper.texels(bytes.first(bytes.size() / 2), 100'000, 100'000).empty());
    EXPECT_TRUE(unzipper.texels(bytes.subspan(1), 100'000, 100'000).empty());
    EXPECT_TRUE(unzipper.texels({}, 100'000, 100'000).empty());
}

// Zeros, stored as differences from 128, fall by 128 at each byte: 0, 128, 0, ... in the even places, continued in the
// odd ones.
TEST(ExrZip, PredictsAndInterleaves) {
    Unzipper unzipper;
    const Bytes chunk = deflated(7'001);
    const auto texels = unzipper.texels(chunk, 7'001, 7'001);
    ASSERT_EQ(texels.size(), 7'001u);
    for (std::size_t k = 0; k < texels.size(); ++k) {
        const std::size_t stored = k % 2 == 0 ? k / 2 : 3'501 + k / 2;
        ASSERT_EQ(texels[k], std::byte(stored % 2 == 0 ? 0 : 128)) << k;
    }
}

TEST(ExrZip, ChunksComeBackAndAreNeverLargerThanTheirTexels) {
    std::mt19937 random(2);
    Zipper zipper;
    Unzipper unzipper;
    for (const std::size_t size : {1u, 2u, 3u, 100u, 4'097u, 70'000u}) {
        for (const unsigned share : {0u, 30u, 256u}) {
            Bytes texels(size);
            for (std::byte& b : texels) b = random() % 256 < share ? static_cast<std::byte>(random()) : std::byte{7};
            zipper.texels = texels;
            const std::span<const std::byte> chunk = zipper.chunk();
            EXPECT_LE(chunk.size(), size);
            if (share == 0 && size > 100) {
                EXPECT_LT(chunk.size(), size / 20);
            }
            const auto back = unzipper.texels(chunk, size, size);
            EXPECT_TRUE(std::equal(back.begin(), back.end(), texels.begin(), texels.end())) << size << ", " << share;
        }
    }
}

}  // namespace
}  // namespace tex
