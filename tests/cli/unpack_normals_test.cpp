// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <tex/tex.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "reference/dds_file.h"

namespace tex::cli {
namespace {

const std::filesystem::path kTextures = TEX_SOURCE_DIR "/../shared/data/dds";

std::vector<std::string> textures() {
    std::vector<std::string> names;
    if (std::filesystem::exists(kTextures)) {
        for (const auto& entry : std::filesystem::recursive_directory_iterator(kTextures)) {
            if (entry.path().extension() == ".dds")
                names.push_back(entry.path().lexically_relative(kTextures).string());
        }
    }
    std::sort(names.begin(), names.end());
    return names;
}

// The largest difference in 8-bit codes between two planes.
int largest_difference(const Plane<float>& a, const Plane<float>& b) {
    float largest = 0.0f;
    for (int j = 0; j < a.extent().height; ++j) {
        for (int i = 0; i < a.extent().width; ++i) largest = std::max(largest, std::abs(a.at(i, j) - b.at(i, j)));
    }
    return static_cast<int>(std::lround(largest * 255.0f));
}

}  // namespace

class UnpackNormals : public testing::Test {
protected:
    Ran go(const std::string& command, std::vector<std::string> arguments) {
        arguments.push_back("--no-sync");
        return run(scratch_, command, arguments);
    }
    Scratch scratch_;
};

TEST_F(UnpackNormals, EveryRealTextureUnpacksOrIsRefused) {
    if (textures().empty()) GTEST_SKIP() << "no ../shared/data";
    for (const std::string& name : textures()) {
        const Ran ran =
            go("unpack-normals", {(kTextures / name).string(), "-o", "x.png", "--quiet", "--effort", "fast"});
        const bool is_height = name == "oiio_dds_dxgi_r16.dds";
        EXPECT_EQ(ran.code, is_height ? 4 : 0) << name << ": " << ran.err;
        EXPECT_EQ(lines_of(ran.err).size(), is_height ? 1u : 0u) << ran.err;
    }
}

// The layouts are those that ../shared/data/SOURCES.md states.
TEST_F(UnpackNormals, LayoutsOfRealTexturesAreRecognised) {
    if (textures().empty()) GTEST_SKIP() << "no ../shared/data";
    const std::pair<const char*, const char*> layouts[] = {{"torque_TP_Ryder_DXT5nm_256_mips9_nvtt.dds", "dxt5nm"},
                                                           {"torque_Grenade2_DXT5nm_GGGR_512_mips10.dds", "dxt5nm"},
                                                           {"torque_rock_DXT5nm_GGGR_256_mips9.dds", "dxt5nm"},
                                                           {"fieldstone_ATI2_512_mips10.dds", "gr"},
                                                           {"amd_wood_ATI2_A2XY_512_mips10.dds", "rg"},
                                                           {"d3d_dwarf_armor_RGBA8_512_mips10.dds", "rgb"}};
    for (const auto& [name, layout] : layouts) {
        const Ran ran = go("unpack-normals", {(kTextures / name).string(), "-o", "x.png", "--json"});
        ASSERT_EQ(ran.code, 0) << name;
        EXPECT_EQ(nlohmann::json::parse(ran.out)["source"]["swizzle"], layout) << name;
    }
}

// Compares x and y with another project's decoder. The files are pictures, not unit vectors, so their length must be
// kept.
TEST_F(UnpackNormals, AgreesWithAnotherDecoderWithinOneCode) {
    if (textures().empty()) GTEST_SKIP() << "no ../shared/data";
    for (const std::string name : {"pillow_bc5_unorm", "run_BC5_nvtt_dx10", "run_BC5_snorm_dx10"}) {
        const std::string file = (kTextures / "reference" / name).string();
        ASSERT_EQ(go("unpack-normals", {file + ".dds", "-o", "x.png", "--keep-length"}).code, 0);
        const auto ours = read_image(scratch_.path("x.png"));
        const auto theirs = read_image(file + ".decoded.png");
        ASSERT_TRUE(ours && theirs);
        EXPECT_LE(largest_difference(ours->planes[0], theirs->planes[0]), 1) << name;
        EXPECT_LE(largest_difference(ours->planes[1], theirs->planes[1]), 1) << name;
    }
}

TEST_F(UnpackNormals, PicturesComeBack) {
    scratch_.add_sample("waves.png", "waves.png");
    ASSERT_EQ(go("bake-normals", {"waves.png", "-o", "n.png", "--bumpiness", "8"}).code, 0);
    ASSERT_EQ(go("bake-normals", {"waves.png", "-o", "n.dds", "--bumpiness", "8", "--format", "rgb8"}).code, 0);
    ASSERT_EQ(go("unpack-normals", {"n.dds", "-o", "again.png", "--keep-length"}).code, 0);
    EXPECT_TRUE(scratch_.read("n.png") == scratch_.read("again.png"));
}

// The bump maps of S.T.A.L.K.E.R.: gloss in R, z in G, y in B, x in A.
TEST_F(UnpackNormals, AnyChannelsCanHoldTheNormals) {
    scratch_.add_sample("waves.png", "waves.png");
    ASSERT_EQ(go("bake-normals", {"waves.png", "-o", "n.png", "--bumpiness", "8"}).code, 0);
    auto texture = read_texture(scratch_.path("n.png"));
    ASSERT_TRUE(texture);
    std::vector<std::byte> turned;
    const std::vector<std::byte> bytes = texture->levels[0].bytes;
    for (std::size_t k = 0; k < bytes.size(); k += 3)
        turned.insert(turned.end(), {bytes[k / 2], bytes[k + 2], bytes[k + 1], bytes[k]});
    texture->format = Format::rgba8_unorm;
    texture->levels[0].bytes = turned;
    texture->swizzle_known = false;
    ASSERT_TRUE(write_texture(scratch_.path("bump.png"), *texture));
    for (const char* channels : {"abg", "x=a,y=b,z=g", "z=g,x=a,y=b"}) {
        ASSERT_EQ(go("unpack-normals", {"bump.png", "-o", "again.png", "--swizzle", channels, "--drop", "--keep-length",
                                        "--format", "rgb8"})
                      .code,
                  0);
        const auto made = read_texture(scratch_.path("again.png"));
        ASSERT_TRUE(made);
        EXPECT_EQ(made->levels[0].bytes, bytes) << channels;
    }
    const Ran two = go("unpack-normals", {"bump.png", "-o", "two.png", "--swizzle", "ab", "--json", "--drop"});
    ASSERT_EQ(two.code, 0);
    EXPECT_EQ(nlohmann::json::parse(two.out)["source"]["swizzle"], "__yx");
    for (const char* wrong : {"aab", "abx", "x=a", "x=a,x=b", "x=a,y=q", "a", "abgr", "y=b,z=g"})
        EXPECT_EQ(go("unpack-normals", {"bump.png", "-o", "x.png", "--swizzle", wrong}).code, 2) << wrong;
}

// A real writer's file is in the data; here the texels of a plane show nothing.
TEST_F(UnpackNormals, AnAssumedOrderIsSaid) {
    MipChain chain;
    chain.levels.emplace_back(Extent{64, 64});
    for (int j = 0; j < 64; ++j) {
        for (int i = 0; i < 64; ++i) {
            chain.levels[0].x.at(i, j) = 0.0f;
            chain.levels[0].y.at(i, j) = 0.0f;
            chain.levels[0].z.at(i, j) = 1.0f;
        }
    }
    const auto texture = pack(chain, {Encoding::bc5});
    ASSERT_TRUE(texture);
    auto file = reference::dds_coded(64, 64, 1, reference::four_cc("ATI2"));
    const auto& bytes = texture->levels[0].bytes;
    file.data.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    scratch_.write("a.dds", write_dds(file));
    const Ran ran = go("unpack-normals", {"a.dds", "-o", "x.png"});
    EXPECT_EQ(ran.code, 0);
    EXPECT_NE(ran.err.find("its FourCC ATI2 leaves open whether x or y comes first, and its texels do not show it"),
              std::string::npos)
        << ran.err;
    EXPECT_EQ(go("unpack-normals", {"a.dds", "-o", "x.png", "--bc5-order", "xy"}).err, "");
}

TEST_F(UnpackNormals, LevelsAreChosen) {
    scratch_.add_sample("waves.png", "waves.png");
    ASSERT_EQ(go("bake-normals", {"waves.png", "-o", "n.dds"}).code, 0);
    ASSERT_EQ(go("unpack-normals", {"n.dds", "-o", "two.png", "--level", "2"}).code, 0);
    EXPECT_EQ(read_image(scratch_.path("two.png"))->extent(), (Extent{32, 32}));
    ASSERT_EQ(go("unpack-normals", {"n.dds", "--level", "all", "--name", "{stem}_{level}.png"}).code, 0);
    EXPECT_TRUE(scratch_.read("n_2.png") == scratch_.read("two.png"));
    EXPECT_TRUE(scratch_.has("n_7.png"));
    const Ran missing = go("unpack-normals", {"n.dds", "-o", "x.png", "--level", "8"});
    EXPECT_EQ(missing.code, 4);
    EXPECT_NE(missing.err.find("has no level 8, only 8"), std::string::npos) << missing.err;
    EXPECT_EQ(go("unpack-normals", {"n.dds", "-o", "x.png", "--level", "all"}).code, 2);
    EXPECT_EQ(go("unpack-normals", {"n.dds", "-o", "x.png", "--level", "-1"}).code, 2);
}

// UnpackScaleNormal: xy = (2 wy - 1) s, z = sqrt(1 - saturate(dot(xy, xy))).
TEST_F(UnpackNormals, ScaleModeXyIsUnpackScaleNormal) {
    scratch_.add_sample("waves.png", "waves.png");
    ASSERT_EQ(go("bake-normals", {"waves.png", "-o", "n.dds", "--bumpiness", "8"}).code, 0);
    ASSERT_EQ(
        go("unpack-normals", {"n.dds", "-o", "x.exr", "--format", "float", "--scale", "0.5", "--scale-mode", "xy"})
            .code,
        0);
    const auto texture = read_texture(scratch_.path("n.dds"));
    const auto stored = decode(*texture, 0);
    const auto ours = read_image(scratch_.path("x.exr"));
    ASSERT_TRUE(stored && ours);
    for (int j = 0; j < 128; j += 7) {
        for (int i = 0; i < 128; i += 5) {
            const float x = (2.0f * stored->planes[3].at(i, j) - 1.0f) * 0.5f;
            const float y = (2.0f * stored->planes[1].at(i, j) - 1.0f) * 0.5f;
            EXPECT_NEAR(ours->planes[static_cast<std::size_t>(ours->find("R"))].at(i, j), x, 1e-6f);
            EXPECT_NEAR(ours->planes[static_cast<std::size_t>(ours->find("G"))].at(i, j), y, 1e-6f);
            EXPECT_NEAR(ours->planes[static_cast<std::size_t>(ours->find("B"))].at(i, j), reconstruct_z(x, y), 1e-6f);
        }
    }
}

}  // namespace tex::cli
