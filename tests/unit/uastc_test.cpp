// SPDX-License-Identifier: Apache-2.0
// UASTC blocks beside Basis Universal's own transcoder.

#include "blocks/uastc.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/file.h>
#include <tex/format.h>
#include <tex/pack.h>

#include "unit/texel_sums.h"

namespace tex {
namespace {

// Two random blocks of each mode, in hexadecimal, and the sum of what three.js 0.187's basis_transcoder.wasm makes of
// them as RGBA32.
struct TranscodedBlock {
    const char* block;
    std::uint64_t sum;
};
constexpr TranscodedBlock kTranscoded[] = {
    {"31b4e652e44da7f2370d9e260e271365", 0x87ae7c77f9667415}, {"71156cf37622c4c83c11dd22dc879e06", 0x6ec652523cfab57f},
    {"75373ea40600f59e32a20944996afdea", 0xd2676aa603c94dc4}, {"75fc806042fab2fde293a23db49e57d3", 0xf6ac590bf55f8f55},
    {"1d97502dd265509c2e3f207082c4409d", 0x4c559e7ff51e7e23}, {"9deed6d28ca2da3b9c4cbbfb36edcdc8", 0xd4fedd6338d32c74},
    {"63c839556b7159fa2f039ae73ee6491e", 0x0af7858ccc86b9a3}, {"432c62cf4ebbbe125a76f6acce03447e", 0x8ff8b4839d98ccc1},
    {"d3c6d41739534f730b8034df67445fd1", 0x2511164845c6ac32}, {"f3be9c089509f4bd4336616bd793c6c5", 0x5f9568fa63d8244a},
    {"cbd3ebcee5d36be89079763681447e5b", 0xc4267149eac1e2c8}, {"0b1b2882cc5d74f8b72f2e24edb0ac32", 0x6cd52b56551de365},
    {"7be1d6616871d47af4ae9e72760ddc9b", 0x1ea327de768e7c7f}, {"bbc4d31db6410cd395267bbb28deec04", 0x7f5cc64b5755852d},
    {"27035574f070be76a6244e77eee51be5", 0x6a847e9e257e6cd1}, {"c746b6a2e41d765dde1704fc5a621e08", 0xab38439bbafb93a5},
    {"f7aa4c29a2adff9594dfaae68b62246e", 0x687896de8c9ee5a5}, {"774348fba12c38d9a2607a80d5295617", 0x20267bb8a9a90f45},
    {"4f55ecff20e0a0102d43e28715a595b1", 0x341f810bcba173d9}, {"0ff3c2609d4ad945eef687ddd0f933b5", 0x8985351fc380c57c},
    {"52eb2ca1bc7c92a30595449301c0b147", 0xd480fc93b9778346}, {"3215c0b46bf00f2388ecf5c47ff6dccd", 0x1fbb7f805c1d4e46},
    {"2826c97cae1c5a7b81ade950c728e239", 0x47d1cc4d859582b4}, {"f8c2a73fa0f2958f9f8cd922f43eccfe", 0x2ec0af6eb2647724},
    {"ced6dffa41cbc5f195d48c3241792315", 0x6dc1feb3ec25e352}, {"9695d5d19a4cf8a2eaa734a14a5181ec", 0x8d4fb8b566179214},
    {"ff637976d4eded602a0035565c3e67b0", 0x551ab3e650511e1e}, {"dfcf31a43823f8f98cde3effa4d92d33", 0x2ad67699d14f2805},
    {"8d19c3075fbf76816bbbf91271c72498", 0x2a0776a554877981}, {"0d0dc367e1b1510bcf77927cc94cd2c1", 0xe41a3840c11ec5c2},
    {"85b73969cc1c9826a66b0f25fdedfb9d", 0xbc77920aba5e4ab6}, {"8580bebeae9be71fefe07fe58ae5cba7", 0xb114cc328dc1fbac},
    {"152fee21732f0dbc7484d12e8f3b7786", 0xa9fdb14aef782596}, {"d56a1a9855c0339f95f0a9714c2ee200", 0xb797ac790bd88976},
    {"e5b7075a8f64f887bc2993f9077e7c99", 0x7079fa11840b1404}, {"2550185a6c02673616024d459ea5a99b", 0x93f515bcf1edc6cf},
    {"69aa97ea679e96ebfe5d5b6629fec3f8", 0x6a0039c9309d3747}, {"c9e8bc3a02471c9b7995f13c61d0f7b8", 0x5723704000dfa31b},
};

std::vector<std::byte> block_of(const std::string& hex) {
    std::vector<std::byte> block;
    for (std::size_t k = 0; k < hex.size(); k += 2)
        block.push_back(static_cast<std::byte>(std::stoi(hex.substr(k, 2), nullptr, 16)));
    return block;
}

TEST(Uastc, BlocksOfAllModesAreThoseOfTheTranscoder) {
    for (const TranscodedBlock& row : kTranscoded) {
        std::uint8_t channels[4][16];
        decode_uastc(block_of(row.block).data(), channels);
        TexelSum sum;
        for (int k = 0; k < 16; ++k) {
            for (const auto& channel : channels) sum.add(channel[k]);
        }
        EXPECT_EQ(sum.value(), row.sum) << row.block;
    }
}

TEST(Uastc, BlocksThatAreNotValidAreMagenta) {
    constexpr std::uint8_t kMagenta[4] = {255, 0, 255, 255};
    const auto expect_magenta = [&](const char* hex) {
        std::uint8_t channels[4][16];
        decode_uastc(block_of(hex).data(), channels);
        for (int c = 0; c < 4; ++c) EXPECT_EQ(std::count(channels[c], channels[c] + 16, kMagenta[c]), 16) << hex;
    };
    expect_magenta("45000000000000000000000000000000");  // the mode that is reserved
    expect_magenta("1d00f001000000000000000000000000");  // mode 2, pattern 31 of 30
    expect_magenta("0300f000000000000000000000000000");  // mode 3, pattern 15 of 11
    expect_magenta("0700f001000000000000000000000000");  // mode 7, pattern 31 of 19
}

TEST(Uastc, ABlockOfOneColourHasItExactly) {
    std::uint64_t bits =
        0x17 | std::uint64_t{200} << 5 | std::uint64_t{3} << 13 | std::uint64_t{254} << 21 | std::uint64_t{90} << 29;
    std::byte block[16] = {};
    for (int k = 0; k < 8; ++k, bits >>= 8) block[k] = static_cast<std::byte>(bits & 255);
    std::uint8_t channels[4][16];
    decode_uastc(block, channels);
    constexpr std::uint8_t kColor[4] = {200, 3, 254, 90};
    for (int c = 0; c < 4; ++c) EXPECT_EQ(std::count(channels[c], channels[c] + 16, kColor[c]), 16);
}

TEST(Uastc, Etc1sIsReadAndNotWritten) {
    for (const Format format : {Format::etc1s_rgb_unorm, Format::etc1s_rgba_unorm}) {
        Texture texture;
        texture.format = format;
        texture.levels.push_back({{4, 4}, std::vector<std::byte>(format_info(format).block_bytes)});
        EXPECT_TRUE(decode(texture, 0));
        for (const auto& row : kContainerNames) {
            EXPECT_FALSE(can_hold(row.value, format)) << row.name;
            EXPECT_FALSE(encode_file(texture, row.value)) << row.name;
        }
    }
}

}  // namespace
}  // namespace tex
