// SPDX-License-Identifier: Apache-2.0

#include "rows/channel_names.h"

#include <gtest/gtest.h>

#include <filesystem>

#include <tex/file.h>
#include <tex/height.h>
#include <tex/pack.h>

#include "formats/exr/exr_rows.h"
#include "unit/exr_files.h"

namespace tex {
namespace {

using Names = std::vector<std::string>;
using Places = std::vector<std::size_t>;

Places places(const Names& names) {
    const Result<NormalChannels> found = normal_channels(names);
    return found ? found->channels : Places{99};
}

TEST(ChannelNames, SayWhichAreXAndYAndZ) {
    EXPECT_EQ(places({"B", "G", "R"}), (Places{2, 1, 0}));
    EXPECT_EQ(places({"A", "B", "G", "R"}), (Places{3, 2, 1, 0}));
    EXPECT_EQ(places({"N.B", "N.G", "N.R"}), (Places{2, 1, 0}));
    EXPECT_EQ(places({"Ci.b", "Ci.g", "Ci.r"}), (Places{2, 1, 0}));
    EXPECT_EQ(places({"b", "g", "r"}), (Places{2, 1, 0}));
    EXPECT_EQ(places({"Blue", "Green", "Red"}), (Places{2, 1, 0}));
    EXPECT_EQ(places({"L.Alpha", "L.BLUE", "L.GREEN", "L.RED"}), (Places{3, 2, 1, 0}));
    EXPECT_EQ(places({"X", "Y", "Z"}), (Places{0, 1, 2}));
    EXPECT_EQ(places({"a.b.z", "a.b.y", "a.b.x"}), (Places{2, 1, 0}));
    EXPECT_EQ(places({"v", "u"}), (Places{1, 0}));
    EXPECT_EQ(places({"G", "R"}), (Places{1, 0}));
    EXPECT_EQ(places({"R", "G", "B", "A", "Z"}), (Places{0, 1, 2, 3}));
    EXPECT_EQ(places({"R", "G", "N.B"}), (Places{0, 1}));
    EXPECT_EQ(places({"foo", "bar"}), Places());
    EXPECT_EQ(places({"Y"}), Places());
    EXPECT_EQ(places({"r", "N.g", "M.b"}), Places());
}

TEST(ChannelNames, OfSeveralLayersTheNormalsAreTaken) {
    const Names render = {"V.Combined.R", "V.Combined.G", "V.Combined.B", "V.Combined.A",
                          "V.Normal.X",   "V.Normal.Y",   "V.Normal.Z"};
    EXPECT_EQ(places(render), (Places{4, 5, 6}));
    EXPECT_EQ(normal_channels(render)->remark, "the layer V.Normal is read, of several that could hold normals");
    EXPECT_EQ(places({"N.X", "N.Y", "N.Z", "R", "G", "B"}), (Places{3, 4, 5}));
    const auto unclear = normal_channels({"P.X", "P.Y", "P.Z", "Q.X", "Q.Y", "Q.Z"});
    ASSERT_FALSE(unclear);
    EXPECT_EQ(unclear.error().reason, "which layer holds the normals is not clear; its layers are P, Q");
    EXPECT_FALSE(normal_channels({"N.X", "N.Y", "N.Z", "Normal.X", "Normal.Y", "Normal.Z"}));
}

TEST(ChannelNames, ALayerIsFoundByItsWholeNameOrItsEnd) {
    const Names names = {"V.Normal.X", "V.Normal.Y", "V.Depth.Z", "Normal.X", "A"};
    EXPECT_EQ(*layer_channels(names, "V.Normal"), (Places{0, 1}));
    EXPECT_EQ(*layer_channels(names, "Normal"), Places{3});
    EXPECT_EQ(*layer_channels(names, "depth"), Places{2});
    EXPECT_EQ(layer_channels(names, "al").error().reason,
              "the picture has no layer \"al\"; its layers are V.Normal, V.Depth, Normal");
    EXPECT_EQ(layer_channels({"a.N.X", "b.N.X"}, "N").error().code, ErrorCode::bad_option);
    EXPECT_EQ(layer_channels({"R", "G"}, "N").error().reason, "the picture has no layer \"N\"; its channels are R, G");
}

TEST(ChannelNames, AListIsPlainTextAndShort) {
    EXPECT_EQ(list_of_names({"a\nb", "c"}), "ab, c");
    EXPECT_EQ(list_of_names(Names(18, "c")).substr(44), " c and 2 more");
}

// The channels hold different values, so that an exchange shows.
TEST(ChannelNames, OneRuleHoldsForTexturesAndPictures) {
    for (const Names& names : {Names{"N.R", "N.G", "N.B"}, Names{"red", "Green", "blue"}, Names{"q.x", "q.y", "q.z"}}) {
        auto file = InputFile::from_memory("n.exr", exr_file({5, 4}, names, Imf::FLOAT, Imf::ZIP_COMPRESSION));
        auto copy = InputFile::from_memory("n.exr", exr_file({5, 4}, names, Imf::FLOAT, Imf::ZIP_COMPRESSION));
        ASSERT_TRUE(file && copy);
        const Result<Texture> texture = read_all(open_exr_texture_rows(*file, {}));
        const Result<Image> image = read_all(open_exr_rows(*copy, {}));
        ASSERT_TRUE(texture && image);
        const Image decoded = *decode(*texture, 0);
        for (int c = 0; c < 3; ++c) EXPECT_EQ(decoded.planes[static_cast<std::size_t>(c)].at(2, 1), exr_value(2, 1, c));
        UnpackOptions raw;
        raw.range = ValueRange::signed_;
        const MipChain chain = *unpack(*texture, raw);
        const NormalMap map = *unpack(*image, raw);
        EXPECT_EQ(chain.levels[0].x.at(3, 2), map.x.at(3, 2));
        EXPECT_EQ(chain.levels[0].z.at(3, 2), map.z.at(3, 2));
    }
}

TEST(ChannelNames, NamesThatSayNothingAreRefusedAndListed) {
    auto file = InputFile::from_memory("n.exr", exr_file({5, 4}, {"a1", "b1", "c1"}, Imf::HALF, Imf::ZIP_COMPRESSION));
    const auto texture = open_exr_texture_rows(*file, {});
    ASSERT_FALSE(texture);
    EXPECT_EQ(texture.error().reason, "no channels are called R, G, B or X, Y, Z; its channels are a1, b1, c1");
}

TEST(ChannelNames, HeightsAreTakenByWholeNamesAndFromLayers) {
    const auto height = [](const Names& names, const HeightOptions& options) {
        Image image;
        image.names = names;
        for (std::size_t k = 0; k < names.size(); ++k)
            image.planes.emplace_back(Extent{1, 1}, static_cast<float>(k + 1) / 8.0f);
        const Result<PictureHeights> field = height_field(image, options);
        return field ? field->height.at(0, 0) : -1.0f;
    };
    HeightOptions options;
    EXPECT_EQ(height({"V.Normal.X", "V.Normal.Y", "V.Normal.Z", "V.Depth.Z"}, options), 0.5f);
    EXPECT_EQ(height({"V.C.R", "V.C.G", "V.C.B", "V.Depth.Z"}, options), 0.5f);
    EXPECT_EQ(height({"a", "height.V", "other.V"}, options), 0.25f);
    EXPECT_EQ(height({"N.X", "N.Y", "N.Z"}, options), -1.0f);
    options.channel_name = "height.y";
    EXPECT_EQ(height({"R", "G", "B", "height.Y"}, options), 0.5f);
    options.channel_name = "height";
    EXPECT_EQ(height({"R", "G", "B", "height.Y"}, options), -1.0f);
    options = {};
    options.channel = HeightChannel::g;
    EXPECT_EQ(height({"Ci.b", "Ci.g", "Ci.r"}, options), 0.25f);
    options.channel = HeightChannel::max;
    EXPECT_EQ(height({"Ci.b", "Ci.g", "Ci.r"}, options), 0.375f);
}

TEST(ChannelNames, APictureWithoutBlueHasNoDataInIt) {
    Image image;
    image.names = {"R", "G", "A"};
    for (const float value : {0.5f, 0.5f, 0.25f}) image.planes.emplace_back(Extent{3, 2}, value);
    UnpackOptions options;
    options.swizzle = kSwizzleXy;
    options.others = {true, true, false};
    const Result<NormalMap> map = unpack(image, options);
    ASSERT_TRUE(map);
    EXPECT_TRUE(map->blue.empty());
}

// The values that OpenImageIO's oiiotool prints for the texel (20, 30) of these files.
TEST(ChannelNames, FilesOfOtherProgramsHoldTheirNormals) {
    const std::string folder = TEX_SOURCE_DIR "/../shared/data/wild/";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no ../shared/data/wild";
    struct Case {
        const char* file;
        float texel[3];
    };
    for (const Case& known : {Case{"layered_exr_N.R_N.G_N.B.exr", {0.277809262f, -0.544942498f, 0.791112959f}},
                              Case{"blender_multilayer_normal.exr", {0.277809262f, -0.544942498f, 0.791112959f}}}) {
        const Result<Texture> texture = read_texture(folder + known.file);
        ASSERT_TRUE(texture) << texture.error().message();
        const Image image = *decode(*texture, 0);
        ASSERT_EQ(image.planes.size(), 3u);
        for (std::size_t c = 0; c < 3; ++c) EXPECT_FLOAT_EQ(image.planes[c].at(20, 30), known.texel[c]) << known.file;
    }
}

}  // namespace
}  // namespace tex
