// SPDX-License-Identifier: Apache-2.0
// KTX2 files of Basis Universal, which ktx2-encoder 0.6.0 made of a normal map of 22x13 texels, beside what three.js
// 0.187's basis_transcoder.wasm makes of them.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tex/check.h>
#include <tex/file.h>
#include <tex/format.h>
#include <tex/pack.h>

#include "files/input_file.h"
#include "formats/bytes.h"
#include "formats/texture_rows.h"
#include "unit/texel_sums.h"
#include "unit/textures.h"

namespace tex {
namespace {

using Bytes = std::vector<std::byte>;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::size_t kSchemeAt = 44, kDescriptorAt = 48, kGlobalAt = 64, kModel = 12, kTransfer = 14, kChannel = 31,
                      kSecondChannel = 47;

Bytes made(const std::string& name) {
    return bytes_of(std::filesystem::path(TEX_SOURCE_DIR "/tests/fuzz/corpus/ktx2/basis-" + name));
}

std::byte& described(Bytes& file, std::size_t at) { return file[load_u32(file.data() + kDescriptorAt) + at]; }

Result<Texture> read(const Bytes& file) { return read_texture(file, "test.ktx2"); }

std::string reason(const Bytes& file) {
    const auto texture = read(file);
    return texture ? "read" : texture.error().reason;
}

// The sums of all levels as RGBA of 8 bits.
std::vector<std::uint64_t> sums_of(const Texture& texture) {
    std::vector<std::uint64_t> sums;
    for (std::size_t k = 0; k < texture.levels.size(); ++k) {
        const auto image = decode(texture, static_cast<int>(k));
        if (!image) return {};
        TexelSum sum;
        for (int j = 0; j < image->extent().height; ++j) {
            for (int i = 0; i < image->extent().width; ++i) {
                for (std::size_t c = 0; c < 4; ++c) {
                    const float value = c < image->planes.size() ? image->planes[c].at(i, j) : 1.0f;
                    sum.add(static_cast<std::uint8_t>(std::lround(value * 255.0f)));
                }
            }
        }
        sums.push_back(sum.value());
    }
    return sums;
}

TEST(Basis, LevelsAreThoseOfTheTranscoder) {
    const auto etc1s = read(made("etc1s-rgb")), slices = read(made("etc1s-two-slices")),
               uastc = read(made("uastc-zstd"));
    ASSERT_TRUE(etc1s && slices && uastc);
    EXPECT_EQ(etc1s->format, Format::etc1s_rgb_unorm);
    EXPECT_THAT(sums_of(*etc1s), ElementsAre(0xba0b3532239b32ed, 0xa651326a6454abd8, 0xd9d3f4bb46d2a504,
                                             0x58038bb68a8fd1b8, 0x6640e0b507e34448));
    EXPECT_EQ(slices->format, Format::etc1s_rgba_unorm);
    EXPECT_THAT(sums_of(*slices), ElementsAre(0xd88194d5290dd8cd, 0xe2e580f84a4098e5, 0x2e7eb9c4da719d66,
                                              0x73e57fbf4198571b, 0xe8075f97b43993c8));
    EXPECT_EQ(uastc->format, Format::uastc_4x4_unorm);
    EXPECT_THAT(sums_of(*uastc), ElementsAre(0xf2c61596a6bbaa63, 0xb73f85009caa6a9c, 0xf46ef49514614ea0,
                                             0x9d23ea00a4e57d92, 0x7bcd8e980812e7b0));
    for (const Texture* texture : {&*etc1s, &*slices, &*uastc}) EXPECT_THAT(texture->remarks, testing::IsEmpty());
}

TEST(Basis, RowsAreThoseOfTheWholeTexture) {
    for (const char* name : {"etc1s-rgb", "etc1s-two-slices", "uastc-zstd"}) {
        auto file = InputFile::from_memory("test.ktx2", made(name));
        ASSERT_TRUE(file);
        const auto whole = read(made(name));
        const auto rows = open_texture_rows(*file, {});
        ASSERT_TRUE(whole && rows) << name;
        for (std::size_t k = 0; k < whole->levels.size(); ++k) {
            const auto image = decode(*whole, static_cast<int>(k));
            ASSERT_TRUE(image);
            const auto compare = [&](const Image& part, int first, int count) -> Result<void> {
                for (std::size_t c = 0; c < image->planes.size(); ++c) {
                    for (int j = 0; j < count; ++j) {
                        const float* const row = image->planes[c].row(first + j);
                        EXPECT_TRUE(std::equal(row, row + image->extent().width, part.planes[c].row(j))) << name;
                    }
                }
                return {};
            };
            EXPECT_TRUE(rows->levels[k]->visit("test.ktx2", compare)) << name;
        }
    }
}

// Texture::swizzle and whether it is stated.
std::string layout(const Bytes& file) {
    const auto texture = read(file);
    if (!texture) return texture.error().reason;
    const auto guessed = guess_swizzle(*texture);
    return to_string(*guessed) + (texture->swizzle_known ? " stated" : "");
}

TEST(Basis, DescriptorsSayWhichChannelsThereAre) {
    Bytes uastc = made("uastc-zstd"), etc1s = made("etc1s-rgb"), slices = made("etc1s-two-slices");
    EXPECT_EQ(layout(uastc), "xyz1 stated");
    EXPECT_EQ(layout(etc1s), "xyz1 stated");
    EXPECT_EQ(layout(slices), to_string(kSwizzleXxxy));  // RGB and alpha: the texels decide
    const auto with = [](Bytes& file, std::size_t at, int channel) {
        described(file, at) = static_cast<std::byte>(channel);
        return layout(file);
    };
    EXPECT_EQ(with(uastc, kChannel, 5), "xxxy stated");  // RRRG
    EXPECT_EQ(with(uastc, kChannel, 6), "xy01 stated");  // RG
    EXPECT_EQ(with(uastc, kChannel, 4), "_001 stated");  // RRR
    EXPECT_EQ(with(uastc, kChannel, 3), "xyz_");         // RGBA
    EXPECT_EQ(with(etc1s, kChannel, 3), "_001 stated");  // RRR
    described(slices, kChannel) = std::byte{3};
    EXPECT_EQ(with(slices, kSecondChannel, 4), "xxxy stated");  // RRR and GGG
}

TEST(Basis, OneChannelHoldsNoNormals) {
    Bytes file = made("uastc-zstd");
    described(file, kChannel) = std::byte{4};
    const auto texture = read(file);
    ASSERT_TRUE(texture);
    const auto chain = unpack(*texture);
    ASSERT_FALSE(chain);
    EXPECT_EQ(chain.error().detail, ErrorDetail::uastc_without_alpha);
    const auto report = check("test.ktx2", *texture);
    ASSERT_TRUE(report);
    const auto is_n114 = [](const Finding& finding) { return finding.rule->id == "N114"; };
    EXPECT_TRUE(std::any_of(report->findings.begin(), report->findings.end(), is_n114));
}

TEST(Basis, ASrgbTransferFunctionIsFound) {
    Bytes file = made("etc1s-two-slices");
    EXPECT_FALSE(read(file)->srgb);
    described(file, kTransfer) = std::byte{2};
    EXPECT_TRUE(read(file)->srgb);
}

TEST(Basis, OtherKindsAreNamedWithAProgramThatConvertsThem) {
    const auto reason_with = [](std::size_t model) {
        Bytes file = made("uastc-zstd");
        described(file, kModel) = static_cast<std::byte>(model);
        return reason(file);
    };
    EXPECT_EQ(reason_with(167),
              "UASTC of high dynamic range is not supported; \"basisu -unpack\" makes files that are");
    EXPECT_THAT(reason_with(169), HasSubstr("XUASTC is not supported; \"basisu -unpack\""));
    EXPECT_THAT(reason_with(163), HasSubstr("ETC1S is stored with BasisLZ alone"));
    Bytes file = made("uastc-zstd");
    file[kSchemeAt] = std::byte{5};
    EXPECT_THAT(reason(file), HasSubstr("XUASTC is not supported"));
    file[kSchemeAt] = std::byte{1};
    EXPECT_THAT(reason(file), HasSubstr("UASTC is not compressed with BasisLZ"));
    Bytes basis(64);
    std::copy_n(reinterpret_cast<const std::byte*>("sB\x13\0"), 4, basis.begin());
    EXPECT_THAT(read_texture(basis, "a.basis").error().message(), HasSubstr("a .basis file is not supported"));
}

TEST(Basis, FramesThatFollowOthersAreUnsupported) {
    Bytes file = made("etc1s-rgb");
    constexpr std::size_t kFlags = 20;
    file[load_u32(file.data() + kGlobalAt) + kFlags] = std::byte{2};
    EXPECT_THAT(reason(file), HasSubstr("animations"));
}

// Whatever byte is damaged, the file is read or refused with a reason, and rows say the same as the whole.
TEST(Basis, DamageIsFoundOrHarmless) {
    int refused = 0;
    for (const char* name : {"etc1s-rgb", "etc1s-two-slices"}) {
        const Bytes good = made(name);
        for (std::size_t at = load_u32(good.data() + kGlobalAt); at < good.size(); ++at) {
            Bytes file = good;
            file[at] ^= std::byte{0x55};
            const auto texture = read(file);
            if (texture) continue;
            ++refused;
            EXPECT_FALSE(texture.error().reason.empty());
            EXPECT_NE(texture.error().code, ErrorCode::out_of_memory) << at;
        }
        for (std::size_t size = 0; size < good.size(); size += 7) {
            EXPECT_FALSE(read(Bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)))) << size;
        }
    }
    EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace tex
