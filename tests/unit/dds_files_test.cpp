// SPDX-License-Identifier: Apache-2.0
// DDS files by other authors: real ones, reference decodes, and hostile ones.

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include <gtest/gtest.h>
#include <png.h>
#include <tex/file.h>
#include <tex/pack.h>

#include "unit/textures.h"

namespace tex {
namespace {

Result<Texture> decode_shared(const std::filesystem::path& path) {
    const std::vector<std::byte> bytes = bytes_of(path);
    return read_texture(bytes, path);
}

TEST(DdsFiles, ReadsEverySharedFile) {
    TEX_NEEDS_SHARED_DATA();
    // Name, extent, levels, swizzle (preceded by '?' if the file does not state it), remarks.
    const std::map<std::string, std::string> expected = {
        {"amd_RedLetters_1k_normal_ATI2_A2XY", "bc5-unorm 512x512 1 xy01 0"},
        {"amd_wood_ATI2_A2XY_512_mips10", "bc5-unorm 512x512 10 xy01 0"},
        {"d3d_RifleStock_DXT1_747x600_mips10_nvtt", "bc1-unorm 747x600 10 ?xyz_ 0"},
        {"d3d_dwarf_armor_RGBA8_512_mips10", "rgba8-unorm 512x512 10 ?xyz_ 0"},
        {"d3d_wall_DENSITY_RGBA8_256_mips9_badflags", "rgba8-unorm 256x256 9 ?xyz_ 0"},
        {"fieldstone_ATI2_512_mips10", "bc5-unorm 512x512 10 ?xy01 0"},
        {"gz_waves_RGB24_256_mips9_gimp", "rgb8-unorm 256x256 9 ?xyz1 0"},
        {"oiio_dds_bc3nm", "bc3-unorm 24x20 1 _y_x 0"},
        {"oiio_dds_bc3rxgb", "bc3-unorm 24x20 1 _yzx 0"},
        {"oiio_dds_bc5", "bc5-unorm 16x8 1 ?xy01 0"},
        {"oiio_dds_dxgi_r16", "r16-unorm 16x8 1 ?_001 0"},
        {"oiio_dds_npot_bc3_mips", "bc3-unorm 13x7 4 ?1y1x 0"},
        {"torque_Grenade2_DXT5nm_GGGR_512_mips10", "bc3-unorm 512x512 10 ?1y1x 0"},
        {"torque_TP_Ryder_DXT5nm_256_mips9_nvtt", "bc3-unorm 256x256 9 ?1y1x 0"},
        {"torque_rock_DXT5nm_GGGR_256_mips9", "bc3-unorm 256x256 9 ?1y1x 0"},
        {"urho_Stone_DXT5_xGxR_1024_mips11", "bc3-unorm 1024x1024 11 _y_x 0"},
        {"pillow_bc5_unorm", "bc5-unorm 256x256 9 ?xy01 0"},
        {"run_BC3n_AGBR_nvtt", "bc3-unorm 129x66 8 _yzx 0"},
        {"run_BC5_nvtt_dx10", "bc5-unorm 129x66 8 ?xy01 0"},
        {"run_BC5_snorm_dx10", "bc5-snorm 129x66 8 ?xy01 0"},
        {"run_DXT5nm_dx9", "bc3-unorm 129x66 8 ?1y1x 0"},
        {"run_RXGB_noalpha", "bc3-unorm 64x64 7 _yzx 0"},
    };
    std::size_t files = 0;
    for (const char* folder : {"dds", "dds/reference"}) {
        for (const auto& path : files_in(folder, ".dds")) {
            ++files;
            const auto texture = decode_shared(path);
            ASSERT_TRUE(texture) << path << texture.error().message();
            std::string found = std::string(name_of(kFormatNames, texture->format)) + " " +
                                std::to_string(texture->extent().width) + "x" +
                                std::to_string(texture->extent().height) + " " +
                                std::to_string(texture->levels.size()) + " " + (texture->swizzle_known ? "" : "?") +
                                to_string(texture->swizzle) + " " + std::to_string(texture->remarks.size());
            ASSERT_EQ(expected.count(path.stem()), 1u) << path << ": " << found;
            EXPECT_EQ(found, expected.at(path.stem())) << path;
        }
    }
    EXPECT_EQ(files, expected.size());
}

TEST(DdsFiles, ReadsOrRefusesEveryBadFile) {
    TEX_NEEDS_SHARED_DATA();
    const std::map<std::string, std::string> expected = {
        {"oiio_crash-1634", "bad-data"},        // 134 of 256 bytes
        {"oiio_crash-bomb-32768", "bad-data"},  // claims a gigabyte
        {"oiio_crash-bpp", "unsupported"},      // says that it is a volume
        {"oiio_dds_bc3_just_header", "bad-data"},
        {"oiio_dds_bc7_just_header", "bad-data"},
        {"pillow_dxt5-colorblock-alpha-issue-4142", "read 1 1"},  // 240 extra bytes
        {"pillow_timeout-041dd17dfde800360a47a172269df127af138c6b", "bad-data"},
        {"pillow_timeout-755a4d204f4208e3597ac3391edebee196462bd0", "bad-data"},
        {"pillow_unimplemented_dxgi_format", "bad-data"},  // B8G8R8X8, with a quarter of its bytes
        {"pillow_unimplemented_pixel_format", "unsupported"},
        {"pillow_zero_mask_totals", "bad-data"},
        {"run_odd_24-bit-uncompressed-odd", "read 1 0"},
        {"run_odd_both-dx10-and-pixel-format", "read 8 0"},  // the DX10 header overrides the pixel format
        {"run_odd_dxt5-simple-odd", "read 1 0"},
        {"run_odd_restricted-header", "read 8 0"},  // A1R5G5B5
        {"run_permissive_dds_header_size_24", "read 1 1"},
        {"run_permissive_dds_pixel_format_size_24", "read 1 1"},
        {"run_permissive_wrong_mipmap_count_1", "read 1 0"},  // 0 levels
        {"run_permissive_wrong_mipmap_count_3", "read 1 2"},  // 2^32 - 1 levels
        {"run_permissive_wrong_mipmap_count_5", "read 1 1"},  // 3 levels, but the file has one
    };
    std::size_t files = 0;
    for (const auto& path : files_in("bad", ".dds")) {
        ++files;
        const auto texture = decode_shared(path);
        const std::string found =
            texture ? "read " + std::to_string(texture->levels.size()) + " " +
                          std::to_string(texture->remarks.size() + (texture->trailing_bytes > 0 ? 1 : 0))
                    : std::string(name_of(kErrorCodeNames, texture.error().code));
        ASSERT_EQ(expected.count(path.stem()), 1u) << path << ": " << found;
        EXPECT_EQ(found, expected.at(path.stem())) << path << (texture ? "" : ": " + texture.error().message());
    }
    EXPECT_EQ(files, expected.size());
}

// A PNG as 8-bit RGBA, through libpng's simplified interface.
struct Picture {
    int width = 0;
    int height = 0;
    std::vector<png_byte> rgba;
};

Picture read_picture(const std::filesystem::path& path) {
    Picture picture;
    png_image image = {};
    image.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_file(&image, path.c_str()) == 0) return picture;
    image.format = PNG_FORMAT_RGBA;
    picture.rgba.resize(PNG_IMAGE_SIZE(image));
    if (png_image_finish_read(&image, nullptr, picture.rgba.data(), 0, nullptr) == 0) return {};
    picture.width = static_cast<int>(image.width);
    picture.height = static_cast<int>(image.height);
    return picture;
}

// The reference decodes have 8-bit codes, with a signed value n as (n + 1) / 2. RXGB files are shown with red restored
// from alpha, DXT5nm files as x, y and the z of those 8-bit x and y (if z is near 0, one code of x changes z by many
// codes).
TEST(DdsFiles, DecodesWithinOneCodeOfTheReference) {
    TEX_NEEDS_SHARED_DATA();
    int files = 0;
    for (const auto& path : files_in("dds/reference", ".dds")) {
        const auto texture = decode_shared(path);
        ASSERT_TRUE(texture);
        const auto image = decode(*texture, 0);
        ASSERT_TRUE(image);
        std::filesystem::path reference = path;
        const Picture picture = read_picture(reference.replace_extension(".decoded.png"));
        ASSERT_EQ(picture.width, image->extent().width) << path;
        ASSERT_EQ(picture.height, image->extent().height) << path;
        const bool red_in_alpha = to_string(texture->swizzle) == "_yzx" || path.stem() == "run_DXT5nm_dx9";
        double worst[4] = {};
        for (int j = 0; j < picture.height; ++j) {
            for (int i = 0; i < picture.width; ++i) {
                const png_byte* code = &picture.rgba[4 * static_cast<std::size_t>(j * picture.width + i)];
                float value[4] = {};
                for (std::size_t c = 0; c < image->planes.size(); ++c) value[c] = image->planes[c].at(i, j);
                if (red_in_alpha) value[0] = value[3];
                if (path.stem() == "run_DXT5nm_dx9") {
                    value[2] = (reconstruct_z(code[0] / 127.5f - 1, code[1] / 127.5f - 1) + 1) / 2;
                }
                const std::size_t channels = red_in_alpha ? 3 : image->planes.size();
                for (std::size_t c = 0; c < channels; ++c) {
                    if (image->sample == SampleKind::snorm) value[c] = (value[c] + 1) / 2;
                    worst[c] =
                        std::max(worst[c], std::abs(std::floor(static_cast<double>(value[c]) * 255 + 0.5) - code[c]));
                }
            }
        }
        for (const double difference : worst) EXPECT_LE(difference, 1.0) << path;
        ++files;
    }
    EXPECT_EQ(files, 6);
}

}  // namespace
}  // namespace tex
