// SPDX-License-Identifier: Apache-2.0

#include "rows/blue_evidence.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <tex/file.h>
#include <tex/mip.h>
#include <tex/pack.h>
#include <tex/pipeline.h>
#include <unistd.h>

#include "normal_maps.h"
#include "scratch.h"

namespace tex {
namespace {

enum class Blue { usual, itself, one };

class BlueFiles : public testing::Test, protected Scratch {
protected:
    // A PNG with x and y as always, and z in one of three ways. Without x: DXT5nm without its alpha.
    [[nodiscard]] std::string write(Blue blue, bool has_x = true, Extent extent = {48, 40}) const {
        const NormalMap map = wavy_map(extent);
        Texture texture;
        texture.format = Format::rgb8_unorm;
        Level level{extent, {}};
        const auto code = [](float c) { return static_cast<std::byte>(std::lround(255.0f * c)); };
        for (int j = 0; j < extent.height; ++j) {
            for (int i = 0; i < extent.width; ++i) {
                const float z = map.z.at(i, j);
                level.bytes.push_back(has_x ? code(0.5f * map.x.at(i, j) + 0.5f) : std::byte{255});
                level.bytes.push_back(code(0.5f * map.y.at(i, j) + 0.5f));
                level.bytes.push_back(blue == Blue::usual    ? code(0.5f * z + 0.5f)
                                      : blue == Blue::itself ? code(z)
                                                             : std::byte{255});
            }
        }
        texture.levels.push_back(std::move(level));
        const std::string path = this->path("a.png");
        EXPECT_TRUE(write_texture(path, texture));
        return path;
    }
    // The greatest angle to the map, in degrees.
    [[nodiscard]] static double angle(const NormalMap& map) {
        const NormalMap wanted = wavy_map(map.extent());
        double least = 1.0;
        for (int j = 0; j < map.extent().height; ++j) {
            for (int i = 0; i < map.extent().width; ++i) {
                const double cosine = static_cast<double>(map.x.at(i, j) * wanted.x.at(i, j)) +
                                      static_cast<double>(map.y.at(i, j) * wanted.y.at(i, j)) +
                                      static_cast<double>(map.z.at(i, j) * wanted.z.at(i, j));
                least = std::min(least, cosine);
            }
        }
        return std::acos(least) * 180.0 / 3.14159265358979;
    }
};

// glTF-Sample-Models 364: z was stored as it is.
TEST_F(BlueFiles, WithZItselfAreReadSo) {
    const std::string path = write(Blue::itself);
    const auto source = read_normals(path);
    ASSERT_TRUE(source) << source.error().message();
    EXPECT_TRUE(source->info.z01);
    EXPECT_LT(angle(source->chain.levels[0]), 1.0);
    SourceOptions usual;
    usual.unpack.range = ValueRange::unsigned_;
    EXPECT_GT(angle(read_normals(path, usual)->chain.levels[0]), 20.0);
    EXPECT_FALSE(read_normals(path, usual)->info.z01);
}

TEST_F(BlueFiles, WithZAsAlwaysAreReadAsAlways) {
    const auto source = read_normals(write(Blue::usual));
    ASSERT_TRUE(source);
    EXPECT_FALSE(source->info.z01);
    EXPECT_LT(angle(source->chain.levels[0]), 1.0);
}

TEST_F(BlueFiles, AreReadTheSameInAStream) {
    for (const Blue blue : {Blue::usual, Blue::itself}) {
        const std::string path = write(blue);
        PackFileOptions options;
        options.pack = [](const SourceInfo&) { return PackOptions{Encoding::float_}; };
        const auto packed = pack_file(path, this->path("b.exr"), Container::exr, options);
        ASSERT_TRUE(packed) << packed.error().message();
        EXPECT_EQ(packed->source.z01, blue == Blue::itself);
        EXPECT_LT(angle(read_normals(this->path("b.exr"))->chain.levels[0]), 1.0);
    }
}

TEST_F(BlueFiles, WithoutXAreRefused) {
    const std::string path = write(Blue::one, false);
    const auto source = read_normals(path);
    ASSERT_FALSE(source);
    EXPECT_EQ(source.error().code, ErrorCode::bad_data);
    EXPECT_EQ(source.error().file, path);
    EXPECT_EQ(source.error().reason.substr(0, 23), "x is not in the file: r");
    const auto packed = pack_file(path, this->path("b.png"), Container::png);
    ASSERT_FALSE(packed);
    EXPECT_EQ(packed.error().reason, source.error().reason);
}

TEST(BlueEvidence, OfAFlatMapIsNone) {
    BlueEvidence blue;
    const float half[4] = {0.5f, 0.5f, 0.5f, 0.5f}, one[4] = {1.0f, 1.0f, 1.0f, 1.0f};
    blue.add_row({half, half, one, nullptr}, 4);
    EXPECT_FALSE(blue.is_certain() || blue.lacks_x() || blue.is_z01());
    BlueEvidence constant;  // one colour is no map without x
    constant.add_row({one, half, one, nullptr}, 4);
    EXPECT_FALSE(constant.lacks_x());
}

}  // namespace
}  // namespace tex
