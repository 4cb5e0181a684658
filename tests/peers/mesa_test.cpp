// SPDX-License-Identifier: Apache-2.0
// What a GPU's driver makes of our files: Mesa's software OpenGL samples every level.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <random>

#include <gtest/gtest.h>

#include "block_gl.h"
#include "peer_texture.h"
#include "software_gl.h"

namespace {

// Mesa decodes to 8 bits with rules of its own: up to two codes, of 255 or of 127, from the exact value.
float two_codes(tex::Format format) {
    return tex::format_info(format).sample == tex::SampleKind::snorm ? 2.0f / 127.0f : 2.0f / 255.0f;
}

// The levels of a DDS file, found by its header's fixed layout (not by our own reader).
std::vector<tex::Level> levels_of_dds(const std::vector<std::byte>& file, tex::Format format) {
    const auto word = [&](std::size_t offset) {
        std::uint32_t value = 0;
        std::memcpy(&value, file.data() + offset, 4);
        return value;
    };
    constexpr std::uint32_t kDx10 = 0x30315844;  // "DX10"
    const tex::Extent base{static_cast<int>(word(16)), static_cast<int>(word(12))};
    std::size_t offset = word(84) == kDx10 ? 148 : 128;
    std::vector<tex::Level> levels;
    for (std::uint32_t k = 0; k < word(28); ++k) {
        const tex::Extent extent{std::max(1, base.width >> k), std::max(1, base.height >> k)};
        const auto blocks =
            static_cast<std::size_t>((extent.width + 3) / 4) * static_cast<std::size_t>((extent.height + 3) / 4);
        const std::size_t size = blocks * tex::format_info(format).block_bytes;
        if (offset + size > file.size()) return {};
        levels.push_back({extent,
                          {file.begin() + static_cast<std::ptrdiff_t>(offset),
                           file.begin() + static_cast<std::ptrdiff_t>(offset + size)}});
        offset += size;
    }
    EXPECT_EQ(offset, file.size()) << "bytes behind the last level";
    return levels;
}

// GL reads (r, g, b, a) of formats with fewer channels as 0, 0, 1 for what is missing: only stored channels are
// compared.
void expect_same_texels(tex::Extent extent, tex::Encoding encoding, tex::DdsHeader header) {
    const tex::Texture texture = peers::bumpy_texture(extent, encoding);
    tex::WriteOptions options;
    options.dds_header = header;
    const auto file = tex::encode_file(texture, tex::Container::dds, options);
    ASSERT_TRUE(file) << file.error().message();
    const auto levels = levels_of_dds(*file, texture.format);
    ASSERT_EQ(static_cast<int>(levels.size()), tex::level_count(extent));
    const auto sampled = peers::sample_levels(texture.format, levels);
    ASSERT_EQ(sampled.size(), levels.size()) << "OpenGL refused the texture";
    for (std::size_t k = 0; k < levels.size(); ++k) {
        const auto ours = tex::decode(texture, static_cast<int>(k));
        ASSERT_TRUE(ours);
        for (int channel = 0; channel < tex::format_info(texture.format).channels; ++channel) {
            EXPECT_LE(peers::largest_difference(*ours, channel, sampled[k], 4), two_codes(texture.format))
                << extent.width << "x" << extent.height << " level " << k << " channel " << channel;
        }
    }
}

TEST(Mesa, SamplesEveryLevelOfDxt5nmAsWeDecodeIt) {
    ASSERT_TRUE(peers::software_gl_works()) << "Mesa's off-screen OpenGL gave no context";
    for (const tex::Extent extent : peers::kExtents) {
        expect_same_texels(extent, tex::Encoding::dxt5nm, tex::DdsHeader::legacy);
        expect_same_texels(extent, tex::Encoding::dxt5nm, tex::DdsHeader::dx10);
    }
}

TEST(Mesa, SamplesEveryLevelOfBc5AsWeDecodeIt) {
    ASSERT_TRUE(peers::software_gl_works());
    for (const tex::Extent extent : peers::kExtents) {
        expect_same_texels(extent, tex::Encoding::bc5, tex::DdsHeader::dx10);
        expect_same_texels(extent, tex::Encoding::bc5_snorm, tex::DdsHeader::dx10);
    }
}

TEST(Mesa, SamplesEveryLevelOfBc7AsWeDecodeIt) {
    ASSERT_TRUE(peers::software_gl_works());
    for (const tex::Extent extent : peers::kExtents) {
        expect_same_texels(extent, tex::Encoding::bc7, tex::DdsHeader::legacy);
        expect_same_texels(extent, tex::Encoding::bc7, tex::DdsHeader::dx10);
    }
}

// Mesa widens the 11 bits to 16 by repeating the highest ones (to 15 and a sign for snorm).
int code_of(float value, tex::SampleKind sample) {
    const int code =
        static_cast<int>(std::lround(std::abs(value) * (sample == tex::SampleKind::snorm ? 32767 : 65535)));
    return value < 0 ? -(code >> 5) : code >> 5;
}

// Mesa decodes ASTC to 8 bits by dropping the lowest of 16, where ours are halves: they differ by one code at most.
// Every second row of blocks is random; most of these blocks are not valid.
TEST(Mesa, SamplesAstcAsWeDecodeIt) {
    ASSERT_TRUE(peers::software_gl_works());
    if (!peers::software_gl_has("GL_KHR_texture_compression_astc_ldr"))
        GTEST_SKIP() << "the off-screen OpenGL of Mesa 25 (Debian 13) has no ASTC";
    for (const tex::Encoding encoding : {tex::Encoding::astc_4x4, tex::Encoding::astc_6x5, tex::Encoding::astc_8x8}) {
        const tex::Extent extent{91, 86};
        tex::NormalMap map(extent);
        for (int j = 0; j < extent.height; ++j) {
            for (int i = 0; i < extent.width; ++i) {
                map.x.at(i, j) = static_cast<float>(0.7 * std::sin(0.2 * i + 0.9 * j));
                map.y.at(i, j) = static_cast<float>(0.6 * std::cos(0.3 * i - 0.1 * j));
                map.z.at(i, j) = tex::reconstruct_z(map.x.at(i, j), map.y.at(i, j));
            }
        }
        const auto chain = tex::build_mip_chain(std::move(map));
        ASSERT_TRUE(chain);
        tex::PackOptions options;
        options.encoding = encoding;
        options.effort = tex::Effort::fast;
        auto texture = tex::pack(*chain, options);
        ASSERT_TRUE(texture);
        std::mt19937 random(7);
        std::vector<std::byte>& blocks = texture->levels[0].bytes;
        const std::size_t pitch = tex::level_bytes(texture->format, {extent.width, 1});
        for (std::size_t row = 0; row < blocks.size(); row += 2 * pitch)
            std::generate_n(blocks.begin() + static_cast<std::ptrdiff_t>(row), pitch,
                            [&] { return static_cast<std::byte>(random()); });
        const auto sampled = peers::sample_levels(texture->format, texture->levels);
        ASSERT_EQ(sampled.size(), texture->levels.size()) << "OpenGL refused the texture";
        const auto ours = tex::decode(*texture, 0);
        ASSERT_TRUE(ours);
        for (int j = 0; j < extent.height; ++j) {
            for (int i = 0; i < extent.width; ++i) {
                for (int c = 0; c < 4; ++c) {
                    const float theirs = sampled[0][static_cast<std::size_t>(4 * (j * extent.width + i) + c)];
                    const float value = ours->planes[static_cast<std::size_t>(c)].at(i, j);
                    ASSERT_NEAR(theirs * 255.0f, value * 255.0f, 1.01f)
                        << tex::name_of(tex::kEncodingNames, encoding) << " " << i << "," << j << " channel " << c;
                }
            }
        }
    }
}

// Random bytes: every table, every multiplier, clamped palettes, and the base -128.
TEST(Mesa, SamplesEveryCodeOfEacAsWeDecodeIt) {
    ASSERT_TRUE(peers::software_gl_works());
    for (const tex::Format format : {tex::Format::eac_r11_unorm, tex::Format::eac_r11_snorm,
                                     tex::Format::eac_rg11_unorm, tex::Format::eac_rg11_snorm}) {
        const tex::FormatInfo info = tex::format_info(format);
        tex::Texture texture;
        texture.format = format;
        std::mt19937 random(3);
        for (int k = 0; k < 9; ++k) {
            tex::Level level{tex::level_extent({300, 260}, k), {}};
            level.bytes.resize(tex::level_bytes(format, level.extent));
            for (std::byte& byte : level.bytes) byte = static_cast<std::byte>(random());
            for (std::size_t b = 0; b + 8 <= level.bytes.size(); b += 72) level.bytes[b + 1] &= std::byte{0x0f};
            for (std::size_t b = 0; b + 8 <= level.bytes.size(); b += 104) level.bytes[b] = std::byte{0x80};
            texture.levels.push_back(std::move(level));
        }
        const auto sampled = peers::sample_levels(format, texture.levels);
        ASSERT_EQ(sampled.size(), texture.levels.size()) << "OpenGL refused the texture";
        const float one = info.sample == tex::SampleKind::snorm ? 1023.0f : 2047.0f;
        for (std::size_t k = 0; k < sampled.size(); ++k) {
            const auto ours = tex::decode(texture, static_cast<int>(k));
            ASSERT_TRUE(ours);
            const tex::Extent extent = texture.levels[k].extent;
            for (int c = 0; c < info.channels; ++c) {
                for (int j = 0; j < extent.height; ++j) {
                    for (int i = 0; i < extent.width; ++i) {
                        const auto at = static_cast<std::size_t>(4 * (j * extent.width + i) + c);
                        const float value = ours->planes[static_cast<std::size_t>(c)].at(i, j);
                        ASSERT_EQ(code_of(sampled[k][at], info.sample), std::lround(value * one))
                            << tex::name_of(tex::kFormatNames, format) << " level " << k << " " << i << "," << j;
                    }
                }
            }
        }
    }
}

// The number of zeros before the first one in a random block, so that every mode of BC7 comes as often.
void set_bc7_mode(std::byte* block, unsigned mode) {
    block[0] = (block[0] & static_cast<std::byte>(~((1u << (mode + 1)) - 1))) | static_cast<std::byte>(1u << mode);
}

// Random blocks of every mode, partition and rotation.
TEST(Mesa, SamplesEveryModeOfBc7AndBc6hAsWeDecodeIt) {
    ASSERT_TRUE(peers::software_gl_works());
    for (const tex::Format format : {tex::Format::bc7_unorm, tex::Format::bc6h_ufloat, tex::Format::bc6h_sfloat}) {
        tex::Texture texture;
        texture.format = format;
        std::mt19937 random(11);
        const tex::Extent base{300, 260};
        for (int k = 0; k < tex::level_count(base); ++k) {  // OpenGL samples no incomplete chain
            tex::Level level{tex::level_extent(base, k), {}};
            level.bytes.resize(tex::level_bytes(format, level.extent));
            for (std::byte& byte : level.bytes) byte = static_cast<std::byte>(random());
            for (std::size_t at = 0; at < level.bytes.size() && format == tex::Format::bc7_unorm; at += 16)
                set_bc7_mode(level.bytes.data() + at, static_cast<unsigned>(at / 16 % 8));
            texture.levels.push_back(std::move(level));
        }
        const auto sampled = peers::sample_levels(format, texture.levels);
        ASSERT_EQ(sampled.size(), texture.levels.size()) << "OpenGL refused the texture";
        for (std::size_t k = 0; k < sampled.size(); ++k) {
            const auto ours = tex::decode(texture, static_cast<int>(k));
            ASSERT_TRUE(ours);
            const tex::Extent extent = texture.levels[k].extent;
            for (int c = 0; c < tex::format_info(format).channels; ++c) {
                for (int j = 0; j < extent.height; ++j) {
                    for (int i = 0; i < extent.width; ++i) {
                        const float theirs = sampled[k][static_cast<std::size_t>(4 * (j * extent.width + i) + c)];
                        const float value = ours->planes[static_cast<std::size_t>(c)].at(i, j);
                        // OpenGL divides codes of 8 bits less exactly; halves are what they are.
                        const bool is_same = format == tex::Format::bc7_unorm
                                                 ? std::lround(theirs * 255.0f) == std::lround(value * 255.0f)
                                                 : theirs == value;
                        ASSERT_TRUE(is_same) << tex::name_of(tex::kFormatNames, format) << " level " << k << " " << i
                                             << "," << j << " channel " << c << ": " << theirs << ", " << value;
                    }
                }
            }
        }
    }
}

TEST(Mesa, ReadsRedOfDxt5nmAsExactlyOne) {
    ASSERT_TRUE(peers::software_gl_works());
    const tex::Texture texture = peers::bumpy_texture({128, 64}, tex::Encoding::dxt5nm);
    const auto sampled = peers::sample_levels(texture.format, texture.levels);
    ASSERT_EQ(sampled.size(), texture.levels.size());
    for (const std::vector<float>& rgba : sampled) {
        for (std::size_t k = 0; k < rgba.size(); k += 4) {
            ASSERT_EQ(rgba[k], 1.0f);
            ASSERT_EQ(rgba[k + 2], 1.0f);
        }
    }
}

}  // namespace
