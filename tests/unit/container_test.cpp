// SPDX-License-Identifier: Apache-2.0

#include <tex/file.h>

#include <sstream>

#include <gtest/gtest.h>
#include <tex/pack.h>

#include "scratch.h"
#include "unit/textures.h"

namespace tex {
namespace {

TEST(Container, IsNamedByTheExtension) {
    EXPECT_EQ(container_of("a.dds"), Container::dds);
    EXPECT_EQ(container_of("a.KTX2"), Container::ktx2);
    EXPECT_EQ(container_of("dir.png/a.Tiff"), Container::tiff);
    EXPECT_EQ(container_of("a.b.tif"), Container::tiff);
    EXPECT_EQ(container_of("a.jpeg"), Container::jpeg);
    EXPECT_EQ(container_of("a.jpg"), Container::jpeg);
    EXPECT_EQ(container_of("a.ktx"), std::nullopt);
    EXPECT_EQ(container_of("dir.png/a"), std::nullopt);
    EXPECT_EQ(container_of("png"), std::nullopt);
    EXPECT_EQ(container_of(""), std::nullopt);
}

TEST(Container, ListsEveryExtensionOfItsNames) {
    for (const auto& row : kContainerNames) {
        EXPECT_EQ(container_of("x." + std::string(row.name)), row.value);
        std::istringstream extensions{std::string(row.meaning)};  // ".tif, .tiff"
        for (std::string extension; std::getline(extensions >> std::ws, extension, ',');) {
            EXPECT_EQ(container_of("x" + extension), row.value) << extension;
        }
    }
}

TEST(Container, HoldsItsDefaultEncoding) {
    for (const auto& row : kContainerNames) {
        const bool holds_heights = row.value == Container::r16 || row.value == Container::r32;  // and no normals
        EXPECT_NE(can_hold(row.value, default_encoding(row.value)), holds_heights) << row.name;
    }
    EXPECT_EQ(default_encoding(Container::dds), Encoding::dxt5nm);
    EXPECT_EQ(default_encoding(Container::exr), Encoding::half);
    EXPECT_EQ(default_encoding(Container::tiff), Encoding::rgb16);
    EXPECT_EQ(default_encoding(Container::tga), Encoding::rgb8);
}

// DDS has no numbers for EAC, ASTC and UASTC.
TEST(Container, HoldsEveryEncodingInKtx2AndNearlyEveryOneInDds) {
    for (const auto& row : kEncodingNames) {
        const bool is_eac = row.value == Encoding::eac_rg11 || row.value == Encoding::eac_rg11_snorm;
        const bool is_astc = row.name.substr(0, 4) == "astc";
        const bool is_uastc = row.name.substr(0, 5) == "uastc";
        EXPECT_TRUE(can_hold(Container::ktx2, row.value)) << row.name;
        EXPECT_EQ(can_hold(Container::dds, row.value), !is_eac && !is_astc && !is_uastc) << row.name;
        EXPECT_EQ(can_hold(Container::astc, row.value), is_astc) << row.name;
        EXPECT_FALSE(can_hold(Container::jpeg, row.value) && row.value != Encoding::rgb8) << row.name;
    }
    EXPECT_FALSE(can_hold(Container::png, Encoding::bc5));
    EXPECT_FALSE(can_hold(Container::tga, Encoding::rgb16));
    EXPECT_TRUE(can_hold_levels(Container::exr));
    EXPECT_FALSE(can_hold_levels(Container::png));
}

// The format of a roughness map determines which containers can hold it.
TEST(Container, HoldsFormats) {
    EXPECT_TRUE(can_hold(Container::ktx2, Format::bc4_unorm) && can_hold_blocks(Container::ktx2));
    EXPECT_TRUE(can_hold(Container::ktx2, Format::eac_r11_unorm) && !can_hold(Container::dds, Format::eac_r11_unorm));
    EXPECT_FALSE(can_hold(Container::tiff, Format::bc4_unorm) || can_hold_blocks(Container::tiff));
    EXPECT_TRUE(can_hold(Container::tiff, Format::r32_float) && can_hold(Container::png, Format::r16_unorm));
    EXPECT_FALSE(can_hold(Container::png, Format::r16_float) || can_hold(Container::tga, Format::r16_unorm));
    EXPECT_TRUE(can_hold(Container::exr, Format::r16_float) && can_hold(Container::jpeg, Format::r8_unorm));
    EXPECT_FALSE(can_hold(Container::exr, Format::r8_unorm) || can_hold(Container::jpeg, Format::rgba8_unorm));
}

TEST(Container, GivesEqualBytesForEqualTextures) {
    for (const auto& row : kEncodingNames) {
        for (const Container container : {Container::dds, Container::ktx2}) {
            if (!can_hold(container, row.value)) continue;
            const auto once = encode_file(encoded_texture(row.value, {13, 7}, 4), container);
            const auto twice = encode_file(encoded_texture(row.value, {13, 7}, 4), container);
            ASSERT_TRUE(once && twice);
            EXPECT_EQ(*once, *twice);
        }
    }
}

TEST(Container, IsCompressedAlikeByAnyNumberOfThreads) {
    const Texture texture = encoded_texture(Encoding::half, {700, 900}, 10);
    const Texture picture = encoded_texture(Encoding::rgb8, {900, 700}, 1);
    const auto exr = encode_file(texture, Container::exr, {}, {1, {}});
    const auto png = encode_file(picture, Container::png, {}, {1, {}});
    ASSERT_TRUE(exr && png);
    for (const int threads : {2, 3, 8}) {
        EXPECT_TRUE(encode_file(texture, Container::exr, {}, {threads, {}}).value() == *exr) << threads;
        EXPECT_TRUE(encode_file(picture, Container::png, {}, {threads, {}}).value() == *png) << threads;
    }
}

TEST(Container, RefusesOtherFilesFromMemory) {
    const std::vector<std::byte> other(200, std::byte{'x'});
    const auto texture = read_texture(other, "other.dds");
    ASSERT_FALSE(texture);
    EXPECT_EQ(texture.error().code, ErrorCode::bad_data);
    EXPECT_EQ(texture.error().file, "other.dds");
    EXPECT_EQ(read_texture(std::span<const std::byte>(), "empty").error().reason, "is empty");
}

class ContainerFiles : public testing::Test, protected Scratch {};

// The content, not the name, determines how a file is read.
TEST_F(ContainerFiles, ReadsWhatItWroteWhateverItsName) {
    struct Case {
        const char* name;
        Encoding encoding;
        int levels;
    };
    const Case cases[] = {{"a.dds", Encoding::dxt5nm, 4}, {"a.ktx2", Encoding::bc5, 4},  {"a.png", Encoding::rgb8, 1},
                          {"a.png", Encoding::rgba8, 1},  {"a.png", Encoding::rgb16, 1}, {"a.exr", Encoding::half, 1},
                          {"a.exr", Encoding::float_, 1}, {"a.tif", Encoding::rgb16, 1}, {"a.tiff", Encoding::half, 1},
                          {"a.tga", Encoding::rgba8, 1},  {"a.bmp", Encoding::rgb8, 1}};
    for (const Case& c : cases) {
        const Texture texture = encoded_texture(c.encoding, {13, 7}, c.levels);
        const auto written = write_texture(path(c.name), texture);
        ASSERT_TRUE(written) << written.error().message();
        std::filesystem::rename(path(c.name), path("nameless"));
        const auto read = read_texture(path("nameless"));
        ASSERT_TRUE(read) << read.error().message();
        ASSERT_EQ(read->levels.size(), texture.levels.size()) << c.name;
        const auto before = decode(texture, 0);
        const auto after = decode(*read, 0);
        ASSERT_EQ(after->planes.size(), before->planes.size());
        for (std::size_t k = 0; k < before->planes.size(); ++k) {
            for (int i = 0; i < 13; ++i) EXPECT_EQ(after->planes[k].at(i, 6), before->planes[k].at(i, 6)) << c.name;
        }
    }
}

TEST_F(ContainerFiles, SaysWhatAContainerCanHold) {
    const auto refused = write_texture(path("a.png"), encoded_texture(Encoding::bc5, {4, 4}, 1));
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::unsupported);
    EXPECT_EQ(refused.error().file, path("a.png"));
    EXPECT_FALSE(std::filesystem::exists(path("a.png")));
    const auto nameless = write_texture(path("a"), encoded_texture(Encoding::rgb8, {4, 4}, 1));
    EXPECT_EQ(nameless.error().code, ErrorCode::bad_option);
}

TEST_F(ContainerFiles, TellMissingFilesFromDamagedOnes) {
    EXPECT_EQ(read_texture(path("missing.dds")).error().code, ErrorCode::io);
    EXPECT_EQ(read_texture(folder_).error().code, ErrorCode::io);
    std::ofstream(path("empty.dds")).close();
    EXPECT_EQ(read_texture(path("empty.dds")).error().code, ErrorCode::bad_data);
}

}  // namespace
}  // namespace tex
