// SPDX-License-Identifier: Apache-2.0

#include "formats/file_layout.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <tex/file.h>

#include "formats/dds/dds.h"
#include "formats/ktx2/ktx2.h"
#include "unit/textures.h"

namespace tex {
namespace {

TEST(FileLayout, RearrangesTexels) {
    const std::vector<std::byte> rgb = {std::byte{1}, std::byte{2}, std::byte{3}};
    std::byte out[4] = {};
    rearrange_texels(Format::rgb8_unorm, Rearrange::bgr, rgb.data(), 1, out);
    EXPECT_TRUE(out[0] == std::byte{3} && out[1] == std::byte{2} && out[2] == std::byte{1});
    rearrange_texels(Format::rgb8_unorm, Rearrange::widen, rgb.data(), 1, out);
    EXPECT_TRUE(out[0] == std::byte{1} && out[3] == std::byte{255});
    EXPECT_EQ(stored_level_bytes(Format::rgb16_float, {3, 2}, Rearrange::widen), 48u);
    EXPECT_EQ(stored_level_bytes(Format::bc3_unorm, {5, 5}, Rearrange::none), 64u);
}

// A writer that knows only the head of a texture can compute the position of every byte.
TEST(FileLayout, FollowsFromTheHeadAlone) {
    for (const auto& row : kEncodingNames) {
        const Texture texture = encoded_texture(row.value, {13, 7}, 4);
        for (const Container container : {Container::dds, Container::ktx2}) {
            if (!can_hold(container, row.value)) continue;
            const FileLayout layout =
                container == Container::dds ? dds_layout(head_of(texture), {}) : ktx2_layout(head_of(texture));
            const auto file = encode_file(texture, container);
            ASSERT_TRUE(file);
            ASSERT_EQ(layout.size, file->size()) << row.name;
            EXPECT_TRUE(std::equal(layout.head.begin(), layout.head.end(), file->begin()));
            std::vector<std::byte> built(layout.size);
            std::copy(layout.head.begin(), layout.head.end(), built.begin());
            const std::size_t block = format_info(texture.format).block_bytes;
            for (std::size_t k = 0; k < 4; ++k) {
                const std::vector<std::byte>& bytes = texture.levels[k].bytes;
                EXPECT_LE(layout.levels[k].offset + layout.levels[k].bytes, layout.size);
                rearrange_texels(texture.format, layout.rearrange, bytes.data(), bytes.size() / block,
                                 built.data() + layout.levels[k].offset);
            }
            EXPECT_EQ(built, *file) << row.name;
        }
    }
}

}  // namespace
}  // namespace tex
