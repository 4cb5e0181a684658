// SPDX-License-Identifier: Apache-2.0
// What transcode() makes of UASTC beside Basis Universal's own transcoder.

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/check.h>
#include <tex/format.h>
#include <tex/pack.h>
#include <tex/transcode.h>

#include "blocks/uastc_to.h"
#include "unit/astcenc.h"
#include "unit/packing.h"
#include "unit/texel_sums.h"

namespace tex {
namespace {

// Two random blocks of each mode, and what three.js 0.187's basis_transcoder.wasm makes of them: blocks of BC7, BC1 and
// ASTC in hexadecimal, and the sum of the texels of ETC1.
struct ShownBlock {
    const char *block, *bc7, *bc1, *astc;
    std::uint64_t etc1;
};
constexpr ShownBlock kShown[] = {
    {"31b4e652e44da7f2370d9e260e271365", "c011efe458fffe7f360d9e260e271365", "ef787a4a4f7874f7",
     "420279441de6fe2a59371b8f9b864f33", 0x335038556c6f8599},
    {"71156cf37622c4c83c11dd22dc879e06", "c0a4e38d3098ffff3d11dd22dc879e06", "e29699180a05e72d",
     "42021dee90d119239f861ec4bb447793", 0x2d5d2804dde5dc8f},
    {"75373ea40600f59e32a20944996afdea", "0840361b08804a05ec95ca7da6d560c9", "52351e2067bad5bd",
     "4200436a0050ef290100000029025984", 0xd5f2969bb0c654f9},
    {"75fc806042fab2fde293a23db49e57d3", "08081282447a995ede17f7857e52b487", "a3149d06436b3ad4",
     "420027082ea52fda010000003da46b43", 0x6b33e1761776b44e},
    {"1d97502dd265509c2e3f207082c4409d", "5a2292117b64ee9e89307e40e0048981", "4c87712a06b2f2ca",
     "53481ad0225d46903c0fbe615ff1fb23", 0x668d48215b75befc},
    {"9deed6d28ca2da3b9c4cbbfb36edcdc8", "36f79e993711657b54119876f72b4bc8", "39fde799f0765555",
     "532802d092acc23b9a1c26a4a92022ad", 0x8d7ee0f9089f4891},
    {"63c839556b7159fa2f039ae73ee6491e", "54621e608dbf28ff378f68689c0f314f", "f45fd11d7a94ec39",
     "429013906cbdeb5928413d1e1be63e58", 0x61bf9d79f338bb96},
    {"432c62cf4ebbbe125a76f6acce03447e", "6cfe0731c7bc5074c0804fa9637a0638", "71ccb0796c140428",
     "42305d30c209fcb0f4b0da38f70fa3d6", 0x39f20b5397400fec},
    {"d3c6d41739534f730b8034df67445fd1", "48270ce9c9688485dd4e06ee1781979c", "25845112c9d01d0f",
     "4288415099a66a10c28ca1168d2dfc6e", 0x0bbc64e7f62437e6},
    {"f3be9c089509f4bd4336616bd793c6c5", "98b4aa5fe1ff4f7b8eaaa1f974a4b0e5", "48bbfc841ba26c93",
     "428819b03dee2699ec21601d4e1b4a9c", 0x0a6a8b0a2ac7e0d5},
    {"cbd3ebcee5d36be89079763681447e5b", "c0bbebf31d1efe7fd4f9b9d69d0022d4", "4fe2636d746f0d60",
     "5300b9dc7b7d1c0c0100ecf69b8c0c73", 0x15c9093422aac6d1},
    {"0b1b2882cc5d74f8b72f2e24edb0ac32", "c008d92d22fefe7fdd4f699299dd929b", "d0b21046439e0aa9",
     "53004590b98b0eff000069b825a1a3cf", 0x44d5150e70846209},
    {"7be1d6616871d47af4ae9e72760ddc9b", "a02dd8ff6fd3ffae5dcd3de8bc4b35af", "5e63ed5da32e72cd",
     "4204ad70112dfd50d93bb06e4e79758f", 0xa55701327457b865},
    {"bbc4d31db6410cd395267bbb28deec04", "a048c1ff8fe5e4ee4fffd11018a6f21f", "d695c707fa55bc0c",
     "420441f7e168d74cdfc884eb22219b76", 0xc93a923421300fc1},
    {"27035574f070be76a6244e77eee51be5", "6c6ae3bdb6d65b6f5d1fcaf5a9a38f77", "7aab876f7a644d19",
     "42e816d0e9d195338c2eef09132cc458", 0x797ab7d9f0b0fbe3},
    {"c746b6a2e41d765dde1704fc5a621e08", "d4a1d5565ba1f2cf5f88492775d78a79", "b0becfbc05000005",
     "42e83d70693b3efd6c9083183c23ad3b", 0x421762be5b1943dd},
    {"f7aa4c29a2adff9594dfaae68b62246e", "c081bff107c0011a5a55555555555555", "695ba952aaaaaaaa",
     "fcfdffffffffffff575765654a4a1111", 0x1580e5f713a24135},
    {"774348fba12c38d9a2607a80d5295617", "40400a4026ff01175a55555555555555", "7b227a11aaaaaaaa",
     "fcfdffffffffffff1b1b4242dada0f0f", 0x5894321e8ee49645},
    {"4f55ecff20e0a0102d43e28715a595b1", "804f9b4008029cf840991c212a4a2bc3", "da7961487dafbf75",
     "42e80418020e0ad132247e1886a9a528", 0xab3e26cea233eea0},
    {"0ff3c2609d4ad945eef687ddd0f933b5", "8097731dddafaac9b97746c841e7cfd4", "7f9b6c6fa1a7273f",
     "42883b985ccb59e46e7fd80d55e9c03a", 0x3da3e4349e54ec31},
    {"52eb2ca1bc7c92a30595449301c0b147", "c0dcdb77ffcefe4c0595449301c0b147", "afc61774b5bf15e1",
     "4282fdc20d890b3ae28d0380c922a940", 0xdec3b63db3add42d},
    {"3215c0b46bf00f2388ecf5c47ff6dccd", "4076dd143c83feff89ecf5c47ff6dccd", "08e4f4da2d911caa",
     "4282e7eaa3e808024cc49001dc50c8de", 0xaeb21322d40c8645},
    {"2826c97cae1c5a7b81ade950c728e239", "a051054edd612633219306b5b94e2d2c", "47a4521ce08ec16f",
     "4284a51d5ddd2c5d63b8eb1cf5684afe", 0x554403929a0d1b73},
    {"f8c2a73fa0f2958f9f8cd922f43eccfe", "6077dcecfcde19450d4ad9c1bb0e3dff", "6e4e3b4b5faf2125",
     "428431851fc51b1c7f337c2f449b31a9", 0x5206cebe24ffc2f3},
    {"ced6dffa41cbc5f195d48c3241792315", "c090e585cb554b1a28244640f22b440b", "ee42952b228a343a",
     "5380412ddcf8b835320da8c49e824c51", 0xcbf850a1e1ac1321},
    {"9695d5d19a4cf8a2eaa734a14a5181ec", "c0395a1086af8315d809b444420b20f6", "7be0bacd36ae3860",
     "53801b33045f91aa3f2a37818a52854c", 0xd034c85613b0e4c5},
    {"ff637976d4eded602a0035565c3e67b0", "20a8ed3648055063999fe719c0f03303", "00b4b55511100451",
     "41846fa3066f0152b1a801c09f3158dc", 0xfdfaaf663c21e71b},
    {"dfcf31a43823f8f98cde3effa4d92d33", "e071237cdef7cfe89961fe610ccfcc33", "ebde2b8f44105510",
     "418419c5cfc1f566f8f70180b344a6cd", 0x1bd9b19ab4625c8b},
    {"8d19c3075fbf76816bbbf91271c72498", "40bcdeb6e06e9d170b0afafaa0a55000", "d6f056eb6722b95d",
     "4280ebe12fd66c715f360100dfe6887b", 0xb430432dd7c40df5},
    {"0d0dc367e1b1510bcf77927cc94cd2c1", "c0c5c3b1c5fb2865fa0aa5a5a550aa0f", "af25dd1863bbdb4a",
     "42802d3c366ae1f94e9201005c9299b4", 0xd80278e5567c6d0c},
    {"85b73969cc1c9826a66b0f25fdedfb9d", "404c0e93c3e460cd315d7b28e96fdfef", "8e738631cd6ec200",
     "428262e6c0340100f7fbf69714deba0c", 0x0f0244b8e63fae4f},
    {"8580bebeae9be71fefe07fe58ae5cba7", "c0eead7bebde9e407807ff2b572c5f3e", "d7bd6d6b2a353a99",
     "428274dd3cff00007cfa34ead4ffe02e", 0x2149f3540eee492d},
    {"152fee21732f0dbc7484d12e8f3b7786", "80da4e83ed34d84e830163338d3b7786", "fbde4529d63fb7d7",
     "42e82c887b69e0a5238c761961eedca1", 0x22fef52fef299f7d},
    {"d56a1a9855c0339f95f0a9714c2ee200", "800c79a293273a79a2b791d94f5cc401", "7defa3186f622655",
     "42083ea8029ef9ac844f8d03004774a4", 0xf93dac9f7ba25a08},
    {"e5b7075a8f64f887bc2993f9077e7c99", "203d494fd2930cffe8d31f661905cf3b", "cf7b2421587e05d1",
     "4284f448867f00c0f4f103ff4ca6ec09", 0x45a57c86a99e624d},
    {"2550185a6c02673616024d459ea5a99b", "20b1442c114be0cc4630e1b94da88e51", "0c63a21032ec5064",
     "4284c426706601c0ae2ccd1395054283", 0xd917dc797bebbce3},
    {"69aa97ea679e96ebfe5d5b6629fec3f8", "4065ea7f9e97feffeaed6f5653e50ff1", "fb978a5656a96841",
     "530295cc3f71e03c806b99254580282e", 0x6e2454766703db21},
    {"c9e8bc3a02471c9b7995f13c61d0f7b8", "40efda08c845feffcc935bf34e0cdeb1", "24d04ebcbb3e6c90",
     "5302f5059138e210f479c3705661268f", 0x141e30d4ba1cbae3},
};

std::vector<std::byte> bytes_of(const std::string& hex) {
    std::vector<std::byte> bytes;
    for (std::size_t k = 0; k < hex.size(); k += 2)
        bytes.push_back(static_cast<std::byte>(std::stoi(hex.substr(k, 2), nullptr, 16)));
    return bytes;
}

TEST(Transcode, BlocksAreThoseOfTheTranscoder) {
    for (const ShownBlock& row : kShown) {
        const std::vector<std::byte> block = bytes_of(row.block);
        std::vector<std::byte> bc7(16), bc1(8);
        uastc_to_bc7(block.data(), bc7.data());
        EXPECT_EQ(bc7, bytes_of(row.bc7)) << row.block;
        uastc_to_bc1(block.data(), bc1.data());
        EXPECT_EQ(bc1, bytes_of(row.bc1)) << row.block;
        std::uint8_t rgb[16][3];
        uastc_to_etc1(block.data(), rgb);
        TexelSum sum;
        for (const auto& texel : rgb) {
            for (const std::uint8_t code : texel) sum.add(code);
        }
        EXPECT_EQ(sum.value(), row.etc1) << row.block;
    }
}

// Beside Arm's decoder.
TEST(Transcode, AstcIsWhatItsBlocksDecodeTo) {
    Astcenc astcenc({4, 4});
    for (const ShownBlock& row : kShown) {
        const std::vector<std::byte> astc = bytes_of(row.astc);
        const std::vector<float> rgba = astcenc.decode(astc.data(), astc.size(), {4, 4});
        Texture texture;
        texture.format = Format::uastc_4x4_unorm;
        texture.levels.push_back({{4, 4}, bytes_of(row.block)});
        const Result<Texture> shown = transcode(texture, GpuFormat::astc);
        ASSERT_TRUE(shown);
        const Result<Image> image = decode(*shown, 0);
        ASSERT_TRUE(image);
        for (int k = 0; k < 16; ++k) {
            for (std::size_t c = 0; c < 4; ++c)
                EXPECT_NEAR(image->planes[c].at(k % 4, k / 4), rgba[4 * static_cast<std::size_t>(k) + c], 1e-5)
                    << row.block;
        }
    }
}

// Every format shows the map, with its levels and at any extent.
TEST(Transcode, MapsAreShown) {
    const MipChain chain = packing::chain_of(packing::bumpy({37, 22}, 5));
    const Result<PackedTexture> texture = pack(chain, {Encoding::uastc});
    ASSERT_TRUE(texture);
    const auto mean_of_shown = [&](const Texture& shown) {
        const Result<MipChain> unpacked = unpack(shown);
        EXPECT_TRUE(unpacked);
        return compare(chain.levels[0], unpacked->levels[0])->error.mean;
    };
    const double plain = mean_of_shown(*texture);
    for (const auto& row : kGpuFormatNames) {
        const Result<Texture> shown = transcode(*texture, row.value);
        ASSERT_TRUE(shown) << row.name;
        const bool is_close = row.value == GpuFormat::astc || row.value == GpuFormat::bc7;
        EXPECT_NEAR(mean_of_shown(*shown), plain, is_close ? 0.25 * plain : 3.0 * plain) << row.name;
    }
}

TEST(Transcode, WhatNobodyTranscodesIsRefused) {
    Texture texture;
    texture.format = Format::bc7_unorm;
    texture.levels.push_back({{4, 4}, std::vector<std::byte>(16)});
    EXPECT_EQ(transcode(texture, GpuFormat::bc1).error().code, ErrorCode::bad_option);
    texture.format = Format::etc1s_rgba_unorm;
    EXPECT_EQ(transcode(texture, GpuFormat::bc7).error().code, ErrorCode::bad_option);
    EXPECT_TRUE(transcode(texture, GpuFormat::etc1));
    texture.swizzle = kSwizzleXxxy;
    EXPECT_EQ(transcode(texture, GpuFormat::etc1).error().code, ErrorCode::bad_option);
    texture.levels[0].bytes.resize(3);
    EXPECT_EQ(transcode(texture, GpuFormat::etc1).error().code, ErrorCode::bad_option);
}

// Blocks that are not valid give zeros, as the transcoder leaves them.
TEST(Transcode, HostileBlocksAreTranscoded) {
    std::mt19937 random(3);
    for (int n = 0; n < 20000; ++n) {
        std::byte block[16], out[16];
        for (std::byte& byte : block) byte = static_cast<std::byte>(random() % 256);
        std::uint8_t rgb[16][3];
        std::uint16_t rgba[16][4];
        uastc_to_bc7(block, out);
        uastc_to_bc1(block, out);
        uastc_to_etc1(block, rgb);
        uastc_to_astc(block, rgba);
    }
    std::byte reserved[16] = {std::byte{0x45}}, out[16];
    uastc_to_bc7(reserved, out);
    EXPECT_EQ(std::count(out, out + 16, std::byte{0}), 16);
}

}  // namespace
}  // namespace tex
