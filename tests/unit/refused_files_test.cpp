// SPDX-License-Identifier: Apache-2.0
// Files that are not read say what they are, and which program makes a file of them that is.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <tex/file.h>

#include "files/input_file.h"
#include "formats/row_source.h"

namespace tex {
namespace {

std::string reason_of(std::string_view text, const std::string& name) {
    const auto bytes = std::as_bytes(std::span(text.data(), text.size()));
    Result<InputFile> file = InputFile::from_memory(name, {bytes.begin(), bytes.end()});
    if (!file) return file.error().reason;
    const auto image = read_image(*file, {});
    return image ? "read" : image.error().reason;
}

TEST(RefusedFiles, APointerOfGitLfsIsOneWhateverItsName) {
    constexpr std::string_view kPointer =
        "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a214614ab2935c943f9e0ff69d22eadbb8f32b1258da\nsize "
        "12345\n";
    for (const char* name : {"a.png", "a.dds", "a.r16", "a.hgt", "a.bil", "a.tif"})
        EXPECT_EQ(reason_of(kPointer, name), "a Git LFS pointer, not the file itself; \"git lfs pull\" fetches it")
            << name;
}

TEST(RefusedFiles, APngOfXcodeIsOne) {
    EXPECT_EQ(
        reason_of(std::string_view("\x89PNG\r\n\x1a\n\0\0\0\4CgBI\x50\0\x20\2\x2b\xd5\xb3\x7f\0\0\0\rIHDR", 32),
                  "a.png"),
        "a PNG that Xcode changed for iPhones (CgBI); \"xcrun pngcrush -revert-iphone-optimizations\" or pngdefry "
        "converts it");
}

TEST(RefusedFiles, FormatsOfDdsHaveTheirNames) {
    const std::string folder = TEX_SOURCE_DIR "/../shared/data/wild/tex/";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no ../shared/data/wild";
    const std::pair<const char*, const char*> files[] = {
        {"l6v5u5.dds",
         "the pixel format L6V5U5, signed x and y with luminance, is not supported; "
         "\"texconv -f R8G8_SNORM\" converts it"},
        {"x8l8v8u8.dds",
         "the pixel format X8L8V8U8, signed x and y with luminance, is not supported; "
         "\"texconv -f R8G8_SNORM\" converts it"},
        {"rgbg.dds",
         "the pixel format RGBG, in which two texels share red and blue, is not supported; "
         "\"texconv -f R8G8B8A8_UNORM\" converts it"},
        {"a2w10v10u10.dds",
         "the pixel format A2W10V10U10, signed with 10 bits, is not supported; "
         "\"texconv -f R16G16B16A16_FLOAT\" converts it"},
        {"dx10_r11g11b10f.dds",
         "DXGI format 26 (R11G11B10_FLOAT) is not supported; "
         "\"texconv -f R16G16B16A16_FLOAT\" converts it"},
    };
    for (const auto& [name, reason] : files) {
        const auto texture = read_texture(folder + name);
        ASSERT_FALSE(texture) << name;
        EXPECT_EQ(texture.error().code, ErrorCode::unsupported);
        EXPECT_EQ(texture.error().reason, reason);
    }
    const auto computed = read_texture(folder + "cxv8u8.dds"), plain = read_texture(folder + "v8u8.dds");
    ASSERT_TRUE(computed) << computed.error().message();
    ASSERT_TRUE(plain);
    EXPECT_EQ(computed->format, Format::rg8_snorm);
    EXPECT_EQ(computed->levels[0].bytes, plain->levels[0].bytes);
}

}  // namespace
}  // namespace tex
