// SPDX-License-Identifier: Apache-2.0

#include "formats/level_planes.h"

#include <cstring>
#include <functional>

#include <gtest/gtest.h>
#include <tex/pack.h>

#include "unit/textures.h"

namespace tex {
namespace {

constexpr Extent kOddExtent{37, 29};  // no multiple of any block

// NaN counts as equal to itself.
bool same_row(const Plane<float>& a, const Plane<float>& b, int j) {
    return std::memcmp(a.row(j), b.row(j), static_cast<std::size_t>(a.extent().width) * sizeof(float)) == 0;
}

bool same_plane(const Plane<float>& a, const Plane<float>& b) {
    for (int j = 0; j < a.extent().height; ++j) {
        if (!same_row(a, b, j)) return false;
    }
    return a.extent() == b.extent();
}

// A texture of BC2 or BC3 in which `change` alters the colours of each block.
Texture colored(Format format, const std::function<void(unsigned block, unsigned& c0, unsigned& c1)>& change) {
    Texture texture = patterned_texture(format, kOddExtent, 1);
    std::byte* const bytes = texture.levels[0].bytes.data();
    for (unsigned block = 0; 16 * block < texture.levels[0].bytes.size(); ++block) {
        std::uint16_t colors[2];
        std::memcpy(colors, bytes + 16 * block + 8, sizeof colors);
        unsigned c0 = colors[0], c1 = colors[1];
        change(block, c0, c1);
        colors[0] = static_cast<std::uint16_t>(c0);
        colors[1] = static_cast<std::uint16_t>(c1);
        std::memcpy(bytes + 16 * block + 8, colors, sizeof colors);
    }
    return texture;
}

Image shared_of(const Texture& texture) {
    PlaneNeeds needs;
    needs.share_constants = true;
    return std::move(decode_planes(texture, texture.levels[0], needs, {}).value());
}

TEST(LevelPlanes, HoldNoMoreThanTheNeededChannels) {
    for (const auto& row : kFormatNames) {
        SCOPED_TRACE(row.name);
        const Texture texture = patterned_texture(row.value, kOddExtent, 2);
        const Image all = std::move(decode(texture, 1).value());
        for (unsigned channels = 0; channels < 16; ++channels) {
            PlaneNeeds needs;
            needs.channels = channels;
            const Image some = std::move(decode_planes(texture, texture.levels[1], needs, {}).value());
            ASSERT_EQ(some.planes.size(), all.planes.size());
            EXPECT_EQ(some.names, all.names);
            for (std::size_t c = 0; c < all.planes.size(); ++c) {
                const bool needed = (channels >> c & 1) != 0;
                EXPECT_EQ(some.planes[c].extent(), all.planes[c].extent());
                EXPECT_EQ(some.planes[c].stride() != 0, needed);
                EXPECT_TRUE(needed ? same_plane(some.planes[c], all.planes[c]) : some.planes[c].at(3, 5) == 0.0f);
            }
        }
    }
}

TEST(LevelPlanes, HoldTheNeededRows) {
    for (const auto& row : kFormatNames) {
        SCOPED_TRACE(row.name);
        const Texture texture = patterned_texture(row.value, kOddExtent, 1);
        const Image all = std::move(decode(texture, 0).value());
        PlaneNeeds needs;
        needs.rows = [](int first, int count) { return first <= 20 && 20 < first + count; };
        const Image some = std::move(decode_planes(texture, texture.levels[0], needs, {}).value());
        for (std::size_t c = 0; c < all.planes.size(); ++c) EXPECT_TRUE(same_row(some.planes[c], all.planes[c], 20));
    }
}

TEST(LevelPlanes, ShareRowsOfOneValue) {
    for (const Format format : {Format::bc2_unorm, Format::bc3_unorm}) {
        const Texture texture = colored(format, [](unsigned, unsigned& c0, unsigned& c1) {
            c0 = (c0 & 0x07E0) | 0xA803;  // red 21, blue 3
            c1 = (c1 & 0x07E0) | 0xA803;
        });
        const Image all = std::move(decode(texture, 0).value());
        const Image shared = shared_of(texture);
        for (std::size_t c = 0; c < 4; ++c) {
            EXPECT_EQ(shared.planes[c].stride() == 0, c == 0 || c == 2);
            EXPECT_TRUE(same_plane(shared.planes[c], all.planes[c]));
        }
    }
}

// One colour of one block is enough.
TEST(LevelPlanes, ShareNoRowsThatDiffer) {
    constexpr unsigned kOneGreen = 0x0020, kOneRed = 0x0800, kOneBlue = 0x0001;
    for (const unsigned difference : {kOneRed, kOneGreen, kOneBlue}) {
        for (const unsigned odd_block : {0u, 7u, 79u}) {
            for (const bool second : {false, true}) {
                const Texture texture = colored(Format::bc3_unorm, [&](unsigned block, unsigned& c0, unsigned& c1) {
                    c0 = c1 = 0x5555;
                    if (block == odd_block) (second ? c1 : c0) ^= difference;
                });
                const Image all = std::move(decode(texture, 0).value());
                const Image shared = shared_of(texture);
                EXPECT_EQ(shared.planes[0].stride() == 0, difference != kOneRed);
                EXPECT_EQ(shared.planes[1].stride() == 0, difference != kOneGreen);
                EXPECT_EQ(shared.planes[2].stride() == 0, difference != kOneBlue);
                EXPECT_NE(shared.planes[3].stride(), 0);
                for (std::size_t c = 0; c < 4; ++c) EXPECT_TRUE(same_plane(shared.planes[c], all.planes[c]));
            }
        }
    }
}

}  // namespace
}  // namespace tex
