// SPDX-License-Identifier: Apache-2.0

#include "formats/astc/astc_file.h"

#include <cstddef>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tex/format.h>

namespace tex {
namespace {

using Bytes = std::vector<std::byte>;
using testing::HasSubstr;

Bytes file_of(const std::vector<int>& header, std::size_t blocks) {
    Bytes bytes;
    for (const int value : header) bytes.push_back(static_cast<std::byte>(value));
    bytes.resize(bytes.size() + 16 * blocks, std::byte{0x21});
    return bytes;
}

// 13x7 texels in blocks of 6x5: three across and two down.
const std::vector<int> kHeader = {0x13, 0xab, 0xa1, 0x5c, 6, 5, 1, 13, 0, 0, 7, 0, 0, 1, 0, 0};

Result<Texture> load(const Bytes& bytes) { return load_texture(parse_astc, bytes.data(), bytes.size(), "f.astc", {}); }

std::string refusal(std::size_t at, int value, ErrorCode code) {
    std::vector<int> header = kHeader;
    header[at] = value;
    const Bytes bytes = file_of(header, 6);
    const auto texture = load(bytes);
    EXPECT_FALSE(texture);
    if (texture) return {};
    EXPECT_EQ(texture.error().code, code);
    EXPECT_EQ(texture.error().file, "f.astc");
    return texture.error().reason;
}

TEST(AstcFile, IsReadAndWrittenByteForByte) {
    const Bytes bytes = file_of(kHeader, 6);
    const auto texture = load(bytes);
    ASSERT_TRUE(texture) << texture.error().message();
    EXPECT_EQ(texture->format, Format::astc_6x5_unorm);
    EXPECT_EQ(texture->extent(), (Extent{13, 7}));
    EXPECT_EQ(layout_name(texture->swizzle), "ra");
    EXPECT_FALSE(texture->swizzle_known || texture->y_known);
    EXPECT_TRUE(texture->remarks.empty());
    const auto again = encode_file(*texture, Container::astc);
    ASSERT_TRUE(again);
    EXPECT_EQ(*again, bytes);
}

TEST(AstcFile, ReportsWhatFollowsTheLastBlock) {
    const auto texture = load(file_of(kHeader, 7));
    ASSERT_TRUE(texture);
    EXPECT_TRUE(texture->remarks.empty());
    EXPECT_EQ(texture->trailing_bytes, 16u);
}

TEST(AstcFile, RefusesWhatItsHeaderCannotMean) {
    EXPECT_THAT(refusal(4, 7, ErrorCode::bad_data), HasSubstr("blocks of 7x5 texels"));
    EXPECT_THAT(refusal(5, 0, ErrorCode::bad_data), HasSubstr("blocks of 6x0 texels"));
    EXPECT_THAT(refusal(6, 3, ErrorCode::unsupported), HasSubstr("volume"));
    EXPECT_THAT(refusal(13, 2, ErrorCode::unsupported), HasSubstr("volume"));
    refusal(7, 0, ErrorCode::bad_data);
    EXPECT_THAT(refusal(9, 1, ErrorCode::bad_data), HasSubstr("truncated: the blocks want"));
    EXPECT_THAT(refusal(12, 255, ErrorCode::unsupported), HasSubstr("16711687"));
}

TEST(AstcFile, RefusesFilesThatEndTooEarly) {
    const Bytes whole = file_of(kHeader, 6);
    for (const std::size_t size : {std::size_t{4}, std::size_t{15}, std::size_t{16}, whole.size() - 1}) {
        const auto texture = load(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)));
        ASSERT_FALSE(texture) << size;
        EXPECT_EQ(texture.error().code, ErrorCode::bad_data) << size;
        EXPECT_THAT(texture.error().reason, HasSubstr("truncated")) << size;
    }
}

}  // namespace
}  // namespace tex
