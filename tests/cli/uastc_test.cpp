// SPDX-License-Identifier: Apache-2.0
// --format uastc: what the commands make of it.

#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace tex::cli {

class WrittenUastc : public testing::Test {
protected:
    WrittenUastc() {
        scratch_.add_sample("bricks.png", "bricks.png");
        does("bake-normals bricks.png -o b.png --bumpiness 8");
    }
    Ran does(const std::string& script) {
        Ran ran = shell(scratch_, "set -e; " + script);
        EXPECT_EQ(ran.code, 0) << script << ": " << ran.out << ran.err;
        return ran;
    }
    // A little-endian number of a file.
    unsigned number(const std::string& name, std::size_t at) {
        const std::string bytes = scratch_.read(name);
        unsigned value = 0;
        for (std::size_t k = 4; k-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + k]);
        return value;
    }
    Scratch scratch_;
};

// KTX 2.0: VkFormat 0, values of 1 byte, scheme 2 (Zstandard). Data Format Specification: model 166, linear transfer,
// blocks of 4x4 texels, one sample of 128 bits, of RGB.
TEST_F(WrittenUastc, IsAFileOfBasisUniversal) {
    does(
        "pack-normals b.png -o u.ktx2 --format uastc --mips all; check-normals u.ktx2 --fail-on warning --require "
        "format=uastc; compare-normals b.png u.ktx2 --max-mean 1.2; "
        "pack-normals b.png -o plain.ktx2 --format uastc --supercompress none");
    EXPECT_EQ(number("u.ktx2", 12), 0u);
    EXPECT_EQ(number("u.ktx2", 16), 1u);
    EXPECT_EQ(number("u.ktx2", 44), 2u);
    EXPECT_EQ(number("plain.ktx2", 44), 0u);
    const std::size_t descriptor = number("u.ktx2", 48), plain = number("plain.ktx2", 48);
    EXPECT_EQ(number("u.ktx2", descriptor + 12) & 0xff00ffu, 0x100a6u);
    EXPECT_EQ(number("u.ktx2", descriptor + 16), 0x0303u);
    EXPECT_EQ(number("u.ktx2", descriptor + 20), 0u);
    EXPECT_EQ(number("plain.ktx2", plain + 20), 16u);
    EXPECT_EQ(number("u.ktx2", descriptor + 28), 127u << 16);
    EXPECT_LT(scratch_.read("u.ktx2").size(), 1.34 * static_cast<double>(scratch_.read("plain.ktx2").size()));
}

// Directions of all three components are promised, and hints go with the blocks that are copied.
TEST_F(WrittenUastc, GetsSmallerWithinAPromisedAngle) {
    does(
        "pack-normals b.png -o u.ktx2 --format uastc --effort fast; "
        "pack-normals b.png -o s.ktx2 --format uastc --effort fast --rdo-mean 0.2 --json > s.json; "
        "check-normals s.ktx2 --fail-on warning; compare-normals b.png s.ktx2 --json > d.json; "
        "compare-normals b.png u.ktx2 --as etc1 --json > e.json; compare-normals b.png s.ktx2 --as etc1 --json > "
        "f.json");
    EXPECT_LT(scratch_.read("s.ktx2").size(), 0.9 * static_cast<double>(scratch_.read("u.ktx2").size()));
    const auto mean = [&](const std::string& name) {
        return nlohmann::json::parse(scratch_.read(name))["degrees"]["mean"].get<double>();
    };
    const auto report = nlohmann::json::parse(scratch_.read("s.json"))["rdo"];
    EXPECT_NEAR(report["mean"].get<double>(), mean("d.json"), 0.01) << "of the base level and smaller ones";
    EXPECT_LE(report["most_growth"].get<double>(), 0.2);
    EXPECT_LT(mean("f.json"), mean("e.json") + 0.6);
}

TEST_F(WrittenUastc, IsComparedAsGpusShowIt) {
    does(
        "pack-normals b.png -o u.ktx2 --format uastc; compare-normals b.png u.ktx2 --as astc --max-mean 1.2; "
        "compare-normals b.png u.ktx2 --as bc7 --max-mean 1.3; compare-normals b.png u.ktx2 --as bc1 --max-mean 4; "
        "compare-normals b.png u.ktx2 --as etc1 --max-mean 4 --level all --report r.html --heatmap h.png");
    EXPECT_EQ(shell(scratch_, "compare-normals b.png u.ktx2 --as etc1 --max-mean 1.2").code, 1);
    const Ran ran = shell(scratch_, "compare-normals u.ktx2 b.png --as bc7");
    EXPECT_EQ(ran.code, 4);
    EXPECT_NE(ran.err.find("b.png: bc7 is made of UASTC and ETC1S"), std::string::npos) << ran.err;
}

TEST_F(WrittenUastc, IsRefusedWhereItCannotBe) {
    const auto fails = [&](const std::string& line, const std::string& reason) {
        const Ran ran = shell(scratch_, line);
        EXPECT_EQ(ran.code, 2) << ran.err;
        EXPECT_NE(ran.err.find(reason), std::string::npos) << ran.err;
    };
    fails("pack-normals b.png -o x.dds --format uastc", "uastc goes into .ktx2");
    fails("pack-normals b.png -o x.ktx2 --format uastc --alpha bricks.png", "alpha");
}

// The picture takes the place of the old one; the extension is used and required.
TEST_F(WrittenUastc, ReplacesTheMapsOfAModel) {
    scratch_.write(
        "m.gltf", R"({"asset":{"version":"2.0"},"materials":[{"normalTexture":{"index":0}}],"textures":[{"source":0}],)"
                  R"("images":[{"uri":"b.png"}]})");
    does(
        "mkdir out same; pack-normals m.gltf -o out/m.gltf --format uastc; compare-normals b.png out/b.ktx2 "
        "--max-mean 1.2; pack-normals m.gltf -o same/m.gltf --for gltf-ktx2; cmp out/b.ktx2 same/b.ktx2");
    const auto model = nlohmann::json::parse(scratch_.read("out/m.gltf"));
    EXPECT_EQ(model["images"][0]["uri"], "b.ktx2");
    EXPECT_EQ(model["textures"][0]["extensions"]["KHR_texture_basisu"]["source"], 0);
    EXPECT_FALSE(model["textures"][0].contains("source"));
    EXPECT_EQ(model["extensionsRequired"][0], "KHR_texture_basisu");
    EXPECT_GT(number("out/b.ktx2", 40), 1u) << "viewers build no levels";
    does("mkdir small; pack-normals m.gltf -o small/m.gltf --format uastc --max-size 64");
    EXPECT_EQ(number("small/b.ktx2", 20), 64u) << "the width";
}

// RRRG: x as luminance and y as alpha, which the descriptor says. glTF forbids it for normals (N801: basis_test.cpp).
TEST_F(WrittenUastc, HoldsXAndYAlone) {
    does(
        "pack-normals b.png -o x.ktx2 --format uastc-rrrg --mips all; check-normals x.ktx2 --fail-on warning --require "
        "format=uastc-rrrg; compare-normals b.png x.ktx2 --max-mean 0.6; unpack-normals x.ktx2 -o back.png --level 0; "
        "compare-normals b.png back.png --max-mean 0.7; compare-normals b.png x.ktx2 --as bc7 --max-mean 0.9; "
        "compare-normals b.png x.ktx2 --as astc --max-mean 0.6; preview-normals x.ktx2 -o p.png; "
        "pack-normals x.ktx2 -o bc5.ktx2 --format bc5; compare-normals b.png bc5.ktx2 --max-mean 0.9; "
        "mip-normals b.png -o m.ktx2 --format uastc-rrrg --roughness-out r.ktx2; check-normals m.ktx2 --fail-on "
        "warning; "
        "pack-normals b.png -o s.ktx2 --format uastc-rrrg --rdo-mean 0.2; compare-normals b.png s.ktx2 --max-mean "
        "0.75");
    EXPECT_EQ(number("x.ktx2", 44), 2u) << "Zstandard";
    EXPECT_EQ(number("x.ktx2", number("x.ktx2", 48) + 28), 127u << 16 | 5u << 24) << "KHR_DF_CHANNEL_UASTC_RRRG";
    EXPECT_LT(scratch_.read("s.ktx2").size(), 0.9 * static_cast<double>(scratch_.read("x.ktx2").size()));
    const Ran ran = shell(scratch_, "compare-normals b.png x.ktx2 --as etc1");
    EXPECT_EQ(ran.code, 4);
    EXPECT_NE(ran.err.find("x or y is in alpha, which etc1 does not have"), std::string::npos) << ran.err;
    scratch_.write(
        "m.gltf", R"({"asset":{"version":"2.0"},"materials":[{"normalTexture":{"index":0}}],"textures":[{"source":0}],)"
                  R"("images":[{"uri":"b.png"}]})");
    EXPECT_EQ(shell(scratch_, "pack-normals m.gltf -o out.gltf --format uastc-rrrg").code, 2);
}

}  // namespace tex::cli
