// SPDX-License-Identifier: Apache-2.0
// Roughness maps written with mip chains: mip-normals --roughness-out.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>

#include <gtest/gtest.h>
#include <tex/tex.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace tex::cli {

class RoughnessOut : public testing::Test {
protected:
    RoughnessOut() {
        scratch_.add_sample("bricks.png", "h.png");
        scratch_.add_sample("waves.png", "waves.png");
        does("bake-normals", {"h.png", "-o", "n.png", "--bumpiness", "12"});
        before_ = scratch_.list();
    }
    Ran go(const std::string& command, std::vector<std::string> arguments) {
        arguments.push_back("--no-sync");
        return run(scratch_, command, arguments);
    }
    std::string does(const std::string& command, const std::vector<std::string>& arguments) {
        const Ran ran = go(command, arguments);
        EXPECT_EQ(ran.code, 0) << command << " " << arguments[0] << ": " << ran.err;
        EXPECT_EQ(without_notes(ran.err), "");
        return ran.out;
    }
    void refuses(std::vector<std::string> arguments, int code, const std::string& part) {
        arguments.insert(arguments.begin(), {"n.png", "-o", "x.dds"});
        const Ran ran = go("mip-normals", arguments);
        EXPECT_EQ(ran.code, code) << part;
        EXPECT_NE(ran.err.find(part), std::string::npos) << ran.err;
        EXPECT_EQ(scratch_.list(), before_) << part;
    }
    Texture texture(const std::string& name) {
        auto read = read_texture(scratch_.path(name));
        EXPECT_TRUE(read) << name;
        return std::move(*read);
    }
    // The mean of one level, of one channel.
    double mean(const std::string& name, int level, std::size_t channel = 0) {
        const auto image = decode(texture(name), level);
        if (!image || channel >= image->planes.size()) return -1.0;
        double sum = 0.0;
        for (int j = 0; j < image->extent().height; ++j) {
            for (int i = 0; i < image->extent().width; ++i) sum += static_cast<double>(image->planes[channel].at(i, j));
        }
        return sum / static_cast<double>(image->extent().texels());
    }

    bool same_red(const std::string& a, const std::string& b) {
        const auto first = read_image(scratch_.path(a)), second = read_image(scratch_.path(b));
        if (!first || !second || first->extent() != second->extent()) return false;
        for (int j = 0; j < first->extent().height; ++j) {
            for (int i = 0; i < first->extent().width; ++i)
                if (std::abs(first->planes[0].at(i, j) - second->planes[0].at(i, j)) > 0.5f / 255.0f) return false;
        }
        return true;
    }

    Scratch scratch_;
    std::vector<std::string> before_;
};

TEST_F(RoughnessOut, HasTheLevelsOfTheNormalsAndGetsRougher) {
    does("mip-normals", {"n.png", "-o", "n.dds", "--roughness-in", "0.25", "--roughness-out", "r.dds"});
    const Texture normals = texture("n.dds"), roughness = texture("r.dds");
    EXPECT_EQ(roughness.format, Format::bc5_unorm);
    ASSERT_EQ(roughness.levels.size(), normals.levels.size());
    for (std::size_t k = 0; k < roughness.levels.size(); ++k)
        EXPECT_EQ(roughness.levels[k].extent, normals.levels[k].extent);
    EXPECT_NEAR(mean("r.dds", 0), 0.25, 0.5 / 255);
    for (int level = 1; level < 4; ++level) EXPECT_GT(mean("r.dds", level), mean("r.dds", level - 1)) << level;
    // The normals must equal those of a run without roughness.
    does("mip-normals", {"n.png", "-o", "alone.dds"});
    EXPECT_TRUE(scratch_.read("alone.dds") == scratch_.read("n.dds"));
}

TEST_F(RoughnessOut, ModelsDifferAsTheyPromise) {
    // alpha^2 of the last level of a mirror, exactly, from floats.
    const auto last = [&](const std::string& model) {
        does("mip-normals", {"n.png", "-o", "n.dds", "--effort", "fast", "--roughness-model", model, "--roughness-out",
                             "r.exr", "--roughness-format", "float"});
        return std::pow(mean("r.exr", static_cast<int>(texture("r.exr").levels.size()) - 1), 4.0);
    };
    const double toksvig = last("toksvig"), vmf = last("vmf");
    const double q = toksvig / (1.0 - toksvig);  // q / (m + q) = toksvig with q = 2 (1 - m)
    const double m = 2.0 / (2.0 + q);
    EXPECT_NEAR(vmf, (1.0 - m * m) / (2.0 * (3.0 * m - m * m * m)), 1e-5);
    does("mip-normals",
         {"n.png", "-o", "n.dds", "--effort", "fast", "--roughness-out", "default.exr", "--roughness-format", "float"});
    EXPECT_NEAR(std::pow(mean("default.exr", 9), 4.0), toksvig, 1e-6);
}

TEST_F(RoughnessOut, FollowsTheExtensionAndTheFormat) {
    const std::pair<std::string, Format> kinds[] = {{"r.ktx2", Format::bc5_unorm}, {"r.exr", Format::r16_float}};
    for (const auto& [name, format] : kinds) {
        does("mip-normals", {"n.png", "-o", "n.dds", "--effort", "fast", "--roughness-out", name});
        EXPECT_EQ(texture(name).format, format) << name;
        EXPECT_EQ(texture(name).levels.size(), texture("n.dds").levels.size()) << name;
        EXPECT_FALSE(texture(name).swizzle_known) << name;
    }
    does("mip-normals", {"n.png", "-o", "n.dds", "--roughness-in", "0.25", "--roughness-out", "e.ktx2",
                         "--roughness-format", "eac-r11"});
    EXPECT_EQ(texture("e.ktx2").format, Format::eac_r11_unorm);
    EXPECT_NEAR(mean("e.ktx2", 0), 0.25, 0.5 / 2047);
    does("mip-normals", {"n.png", "-o", "n.dds", "--effort", "fast", "--mips", "none", "--roughness-in", "0.25",
                         "--roughness-out", "a.astc"});
    EXPECT_EQ(texture("a.astc").format, Format::astc_4x4_unorm);
    does("mip-normals", {"n.png", "-o", "n.dds", "--effort", "fast", "--roughness-in", "0.25", "--roughness-out",
                         "a.ktx2", "--roughness-format", "astc-6x5"});
    EXPECT_EQ(texture("a.ktx2").format, Format::astc_6x5_unorm);
    EXPECT_NEAR(mean("a.ktx2", 0), 0.25, 1.0 / 2048);
    const std::string said = run(scratch_, "check-normals", {"a.ktx2"}).out;
    EXPECT_EQ(said.find("N115"), std::string::npos) << "one value everywhere has no layout: " << said;
    for (const auto& [word, format] : {std::pair{"r8", Format::r8_unorm},
                                       {"r16", Format::r16_unorm},
                                       {"half", Format::r16_float},
                                       {"float", Format::r32_float}}) {
        does("mip-normals",
             {"n.png", "-o", "n.dds", "--effort", "fast", "--roughness-out", "r.dds", "--roughness-format", word});
        EXPECT_EQ(texture("r.dds").format, format) << word;
    }
    does("mip-normals", {"n.png", "-o", "n.dds", "--mips", "none", "--roughness-in", "1", "--roughness-out", "r.png"});
    const auto picture = read_image(scratch_.path("r.png"));
    ASSERT_TRUE(picture);
    EXPECT_EQ(picture->names, std::vector<std::string>{"Y"});
    EXPECT_EQ(picture->planes[0].at(3, 3), 1.0f);
}

// Nobody reads red alone: without an engine it is everywhere, and else where the engine reads it.
TEST_F(RoughnessOut, GoesWhereTheEngineReadsIt) {
    struct Case {
        const char* engine;
        std::string file;
        Format format;
        double red, green, blue, alpha;  // -1: there is no such channel
    };
    const Case cases[] = {
        {"", "r.dds", Format::bc5_unorm, 0.25, 0.25, -1, -1},
        {"", "r.png", Format::r8_unorm, 0.25, -1, -1, -1},
        {"gltf", "r.png", Format::rgb8_unorm, 1, 0.25, 1, -1},
        {"gltf", "r.ktx2", Format::uastc_4x4_unorm, 1, 0.25, 1, 1},
        {"gltf-ktx2", "r.ktx2", Format::uastc_4x4_unorm, 1, 0.25, 1, 1},
        {"babylon", "r.ktx2", Format::uastc_4x4_unorm, 0.25, 0.25, 0.25, 1},
        {"three", "r.ktx2", Format::bc5_unorm, 1, 0.25, -1, -1},
        {"three", "r.exr", Format::rgb16_float, 1, 0.25, 1, -1},
        {"three-packed", "r.ktx2", Format::bc5_unorm, 1, 0.25, -1, -1},
        {"godot", "r.tif", Format::rgb16_unorm, 1, 0.25, 1, -1},
        {"bevy", "r.dds", Format::bc5_unorm, 1, 0.25, -1, -1},
        {"unity", "r.png", Format::rgba8_unorm, 0, 1, 1, 0.75},
        {"unity", "r.dds", Format::rgba8_unorm, 0, 1, 1, 0.75},
        {"unreal", "r.png", Format::r8_unorm, 0.25, -1, -1, -1},
        {"android", "r.ktx2", Format::eac_rg11_unorm, 0.25, 0.25, -1, -1},
    };
    for (const Case& each : cases) {
        SCOPED_TRACE(std::string(each.engine) + " " + each.file);
        std::vector<std::string> arguments = {"n.png",  "-o",   "n.dds",          "--effort", "fast",
                                              "--mips", "none", "--roughness-in", "0.25",     "--roughness-out",
                                              each.file};
        if (*each.engine != '\0') arguments.insert(arguments.end(), {"--for", each.engine, "--format", "bc5"});
        const Ran ran = go("mip-normals", arguments);
        ASSERT_EQ(ran.code, 0) << ran.err;
        EXPECT_EQ(ran.err.find("red is 0, which unity reads as no metal") != std::string::npos, each.red == 0.0);
        EXPECT_EQ(ran.err.find("glTF models hold KTX2"), std::string::npos);
        EXPECT_EQ(texture(each.file).format, each.format);
        EXPECT_NEAR(mean(each.file, 0, 0), each.red, 0.003);
        EXPECT_NEAR(mean(each.file, 0, 1), each.green, 0.003);
        EXPECT_NEAR(mean(each.file, 0, 2), each.blue, 0.003);
        EXPECT_NEAR(mean(each.file, 0, 3), each.alpha, 0.003);
    }
    before_ = scratch_.list();
    refuses({"--for", "gltf", "--format", "bc5", "--roughness-out", "r.dds", "--roughness-format", "bc4"}, 2,
            "--roughness-format bc4 has no channel G of its own, which gltf reads");
    refuses({"--for", "unity", "--format", "bc5", "--roughness-out", "r.dds", "--roughness-format", "bc5"}, 2,
            "--roughness-format bc5 has no channel A of its own, which unity reads");
    refuses({"--for", "three", "--format", "bc5", "--roughness-out", "r.exr", "--roughness-format", "half"}, 2,
            "has no channel G of its own, which three reads");
    does("mip-normals", {"n.png", "-o", "n.dds", "--effort", "fast", "--for", "three", "--format", "bc5",
                         "--roughness-in", "0.25", "--roughness-out", "a.ktx2", "--roughness-format", "astc-6x6"});
    EXPECT_NEAR(mean("a.ktx2", 0, 1), 0.25, 0.003) << "luminance is in green, too";
    const Ran ran = go("mip-normals", {"n.png", "-o", "n.dds", "--effort", "fast", "--for", "gltf", "--format", "bc5",
                                       "--roughness-out", "b.ktx2", "--roughness-format", "bc5"});
    EXPECT_NE(ran.err.find("glTF models hold KTX2 of Basis Universal alone, not of bc5"), std::string::npos) << ran.err;
}

// What KHR_texture_basisu allows: RGB of UASTC, linear, without a swizzle, and all levels.
TEST_F(RoughnessOut, IsUastcInModelsOfGltf) {
    const Ran ran = go("mip-normals", {"n.png", "-o", "n.ktx2", "--for", "gltf-ktx2", "--roughness-in", "0.25",
                                       "--roughness-out", "r.ktx2"});
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_EQ(without_notes(ran.err), "");
    const Texture made = texture("r.ktx2");
    ASSERT_EQ(made.format, Format::uastc_4x4_unorm);
    EXPECT_EQ(made.levels.size(), texture("n.ktx2").levels.size());
    EXPECT_FALSE(made.srgb);
    for (int level = 0; level < 5; ++level) {
        const auto image = decode(made, level);
        ASSERT_TRUE(image);
        for (int j = 0; j < image->extent().height; ++j) {
            for (int i = 0; i < image->extent().width; ++i)
                ASSERT_TRUE(image->planes[0].at(i, j) == 1.0f && image->planes[2].at(i, j) == 1.0f);
        }
        if (level == 0) continue;
        EXPECT_GT(mean("r.ktx2", level, 1), mean("r.ktx2", level - 1, 1)) << level;
    }
    const std::string bytes = scratch_.read("r.ktx2");
    const auto number = [&](std::size_t at) {
        std::uint32_t value = 0;
        for (std::size_t k = 4; k-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + k]);
        return value;
    };
    EXPECT_EQ(number(44), 2u) << "Zstandard, as the normals";
    EXPECT_EQ(number(number(48) + 12), 166u | 1u << 16) << "UASTC, and a linear transfer function";
    EXPECT_EQ(number(number(48) + 28), 127u << 16) << "KHR_DF_CHANNEL_UASTC_RGB";
    for (const char* key : {"KTXswizzle", "libtex.normal"}) EXPECT_EQ(bytes.find(key), std::string::npos) << key;
    does("unpack-normals", {"r.ktx2", "-o", "back.png", "--level", "0"});
    EXPECT_EQ(run(scratch_, "check-normals", {"r.ktx2"}).err, "");
    // The user may say otherwise; UASTC is compressed beside normals that are not.
    does("mip-normals", {"n.png", "-o", "n.ktx2", "--format", "bc5", "--effort", "fast", "--roughness-out", "u.ktx2",
                         "--roughness-format", "uastc"});
    EXPECT_EQ(scratch_.read("u.ktx2")[44], 2);
    EXPECT_EQ(scratch_.read("n.ktx2")[44], 0);
    does("mip-normals", {"n.png", "-o", "n.ktx2", "--format", "bc5", "--effort", "fast", "--roughness-out", "u.ktx2",
                         "--roughness-format", "uastc", "--supercompress", "none"});
    EXPECT_EQ(scratch_.read("u.ktx2")[44], 0);
    before_ = scratch_.list();
    refuses({"--for", "unity", "--format", "bc5", "--roughness-out", "x.ktx2", "--roughness-format", "uastc"}, 2,
            "--roughness-format uastc has no channel A of its own, which unity reads");
    refuses({"--roughness-out", "r.dds", "--roughness-format", "uastc"}, 2, "cannot hold roughness as uastc");
}

class RoughnessInto : public RoughnessOut {
protected:
    RoughnessInto() {
        // Occlusion, roughness, metalness, without and with levels of its own.
        const Ran ran =
            shell(scratch_,
                  "convert h.png -depth 8 -colorspace gray o.png && convert waves.png -resize 512x512! -depth "
                  "8 -colorspace gray r.png && convert h.png -colorspace gray -threshold 50% m.png && "
                  "convert o.png r.png m.png -combine -define png:color-type=2 -depth 8 orm.png");
        EXPECT_EQ(ran.code, 0) << ran.err;
        before_ = scratch_.list();
    }
    Image level(const std::string& name, int k) {
        auto image = decode(texture(name), k);
        EXPECT_TRUE(image) << name;
        return image ? std::move(*image) : Image{};
    }
    static double difference(const Plane<float>& a, const Plane<float>& b) {
        if (a.extent() != b.extent()) return 1.0;
        double most = 0.0;
        for (int j = 0; j < a.extent().height; ++j) {
            for (int i = 0; i < a.extent().width; ++i)
                most = std::max(most, std::abs(static_cast<double>(a.at(i, j)) - static_cast<double>(b.at(i, j))));
        }
        return most;
    }
};

TEST_F(RoughnessInto, MakesATextureWithWhatIsKept) {
    const std::string before = scratch_.read("orm.png");
    does("mip-normals",
         {"n.png", "-o", "n.dds", "--effort", "fast", "--roughness-into", "orm.png:g", "--roughness-out", "orm.dds"});
    EXPECT_TRUE(scratch_.read("orm.png") == before);
    const Texture made = texture("orm.dds");
    EXPECT_EQ(made.format, Format::rgb8_unorm) << "that of the picture";
    EXPECT_EQ(made.levels.size(), 10u);
    const Image base = level("orm.dds", 0), source = level("orm.png", 0);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(difference(base.planes[c], source.planes[c]), 0.0) << c;
    // Green is what it would be alone, and the others are averages.
    does("mip-normals", {"n.png", "-o", "n.dds", "--effort", "fast", "--roughness-in", "orm.png:g", "--roughness-out",
                         "alone.dds", "--roughness-format", "r8"});
    for (int k = 0; k < 10; ++k) {
        EXPECT_EQ(difference(level("orm.dds", k).planes[1], level("alone.dds", k).planes[0]), 0.0) << k;
        for (const std::size_t c : {std::size_t{0}, std::size_t{2}})
            EXPECT_NEAR(mean("orm.dds", k, c), mean("orm.png", 0, c), 0.004) << k;
    }
}

TEST_F(RoughnessInto, MakesUastcForGltf) {
    does("mip-normals", {"n.png", "-o", "n.ktx2", "--for", "gltf-ktx2", "--roughness-into", "orm.png:g",
                         "--roughness-out", "orm.ktx2"});
    does("mip-normals",
         {"n.png", "-o", "n.dds", "--effort", "fast", "--roughness-into", "orm.png:g", "--roughness-out", "orm.dds"});
    ASSERT_EQ(texture("orm.ktx2").format, Format::uastc_4x4_unorm);
    for (int k = 0; k < 10; ++k) {
        const Image made = level("orm.ktx2", k), wanted = level("orm.dds", k);
        double sum = 0.0;
        for (std::size_t c = 0; c < 3; ++c) {
            for (int j = 0; j < made.extent().height; ++j) {
                for (int i = 0; i < made.extent().width; ++i) {
                    const double off =
                        static_cast<double>(made.planes[c].at(i, j)) - static_cast<double>(wanted.planes[c].at(i, j));
                    sum += off * off;
                }
            }
        }
        EXPECT_GT(-10 * std::log10(sum / (3.0 * static_cast<double>(made.extent().texels())) + 1e-9), 30) << k;
    }
    before_ = scratch_.list();
    refuses({"--roughness-into", "orm.png:a", "--roughness-out", "x.ktx2", "--roughness-format", "uastc"}, 2,
            "--roughness-format uastc has no channel A of its own, into which it goes");
}

TEST_F(RoughnessInto, ReplacesATextureWhole) {
    does("mip-normals",
         {"n.png", "-o", "n.dds", "--effort", "fast", "--roughness-into", "orm.png:g", "--roughness-out", "orm.dds"});
    does("mip-normals",
         {"n.png", "-o", "n.dds", "--effort", "fast", "--roughness-in", "0.5", "--roughness-into", "orm.dds:b"});
    const Texture made = texture("orm.dds");
    EXPECT_EQ(made.format, Format::rgb8_unorm);
    ASSERT_EQ(made.levels.size(), 10u);
    EXPECT_NEAR(mean("orm.dds", 0, 2), 0.5, 0.003);
    EXPECT_GT(mean("orm.dds", 4, 2), 0.5);
    // The levels of the others stay as they were.
    does("mip-normals",
         {"n.png", "-o", "n.dds", "--effort", "fast", "--roughness-into", "orm.png:g", "--roughness-out", "again.dds"});
    for (int k = 0; k < 10; ++k) {
        for (const std::size_t c : {std::size_t{0}, std::size_t{1}})
            EXPECT_EQ(difference(level("orm.dds", k).planes[c], level("again.dds", k).planes[c]), 0.0) << k;
    }
    // Once more, it changes nothing; and a link to it stays one.
    std::filesystem::create_symlink("orm.dds", scratch_.path("link.dds"));
    std::string before;
    for (const char* name : {"orm.dds", "link.dds"}) {
        does("mip-normals", {"n.png", "-o", "n.dds", "--effort", "fast", "--roughness-into", std::string(name) + ":b"});
        EXPECT_TRUE(before.empty() || scratch_.read("orm.dds") == before);
        before = scratch_.read("orm.dds");
    }
    EXPECT_TRUE(std::filesystem::is_symlink(scratch_.path("link.dds")));
    // A picture holds one level.
    does("mip-normals", {"n.png", "-o", "n.dds", "--effort", "fast", "--mips", "none", "--roughness-in", "0.5",
                         "--roughness-into", "orm.png:g"});
    EXPECT_NEAR(mean("orm.png", 0, 1), 0.5, 0.003);
    EXPECT_EQ(difference(level("orm.png", 0).planes[0], level("again.dds", 0).planes[0]), 0.0);
}

TEST_F(RoughnessInto, UnitysSmoothnessIsRead) {
    const Ran made = go("mip-normals", {"n.png", "-o", "m.dds", "--for", "unity", "--format", "bc5", "--effort", "fast",
                                        "--roughness-in", "0.25", "--roughness-out", "mask.dds"});
    EXPECT_EQ(made.code, 0) << made.err;
    does("mip-normals", {"n.png", "-o", "m.dds", "--for", "unity", "--format", "bc5", "--mips", "all", "--effort",
                         "fast", "--roughness-into", "mask.dds:a"});
    EXPECT_NEAR(mean("mask.dds", 0, 3), 0.75, 0.003);
    EXPECT_LT(mean("mask.dds", 4, 3), 0.75);
    EXPECT_EQ(mean("mask.dds", 4, 0), 0.0);
}

TEST_F(RoughnessInto, MisuseIsRefused) {
    refuses({"--roughness-into", "orm.png"}, 2, "needs a channel, r, g, b or a");
    refuses({"--roughness-into", "orm.png:luma"}, 2, "needs a channel, r, g, b or a");
    refuses({"--roughness-into", "orm.png:g"}, 2, "png files hold one level; give --roughness-out");
    refuses({"--roughness-into", "orm.png:a", "--roughness-out", "o.dds"}, 4,
            "orm.png: the picture has no channel for \"a\"");
    refuses({"--roughness-into", "orm.png:a", "--roughness-in", "0", "--roughness-out", "o.dds"}, 4,
            "orm.png: has no channel A");
    refuses({"--roughness-into", "waves.png:r", "--roughness-out", "o.dds"}, 4,
            "the texture for roughness is 128x128, the normal map 512x512");
    refuses({"--roughness-into", "none.dds:g"}, 3, "none.dds: ");
    refuses({"--roughness-into", "orm.png:g", "--roughness-out", "orm.png", "--mips", "none"}, 2,
            "the output orm.png is the input orm.png");
    refuses({"--roughness-into", "n.png:g", "--mips", "none"}, 2, "the output n.png is the input n.png");
    refuses({"--roughness-into", "orm.png:g", "--mips", "none", "--update"}, 2, "--update cannot tell");
    does("pack-normals", {"n.png", "-o", "blocks.dds", "--format", "bc5", "--effort", "fast"});
    before_ = scratch_.list();
    const std::string blocks = scratch_.read("blocks.dds");
    refuses({"--roughness-into", "blocks.dds:g"}, 4, "the texture for roughness holds bc5-unorm");
    EXPECT_TRUE(scratch_.read("blocks.dds") == blocks);
    // A picture without a channel that is named.
    refuses({"--roughness-out", "r.dds", "--roughness-in", "orm.png"}, 4, "orm.png: its channels differ (R is 0.");
    refuses({"--roughness-out", "r.dds", "--roughness-in", "orm.png"}, 4, "--roughness-in orm.png:g");
    does("mip-normals",
         {"n.png", "-o", "x.dds", "--effort", "fast", "--roughness-in", "orm.png:g", "--roughness-out", "r.dds"});
    EXPECT_NEAR(mean("r.dds", 0), mean("orm.png", 0, 1), 0.003);
    scratch_.write("normals.toml",
                   "version = 1\n[[rule]]\nmatch = \"n.png\"\nname = \"out/{stem}.dds\"\n"
                   "steps = [ { mip = { roughness-into = \"orm.dds:g\" } } ]\n");
    const Ran build = run(scratch_, "build-normals", {});
    EXPECT_EQ(build.code, 2);
    EXPECT_NE(build.err.find("so a manifest needs --roughness-out"), std::string::npos) << build.err;
}

TEST_F(RoughnessOut, StretchesMapsOfOtherSizes) {
    does("mip-normals", {"n.png", "-o", "n.dds", "--effort", "fast", "--roughness-in", "waves.png", "--roughness-out",
                         "r.dds", "--roughness-format", "float"});
    EXPECT_EQ(texture("r.dds").extent(), (Extent{512, 512}));
    EXPECT_NEAR(mean("r.dds", 0), mean("waves.png", 0), 0.01);
}

TEST_F(RoughnessOut, GoesWithEachInputOfMany) {
    does("bake-normals", {"waves.png", "-o", "w.png", "--bumpiness", "6"});
    std::filesystem::create_directory(scratch_.path("rough"));
    std::filesystem::copy_file(scratch_.path("h.png"), scratch_.path("rough/n.png"));
    std::filesystem::copy_file(scratch_.path("waves.png"), scratch_.path("rough/w.png"));
    const auto out = does("mip-normals", {"n.png", "w.png", "--out-dir", "out", "--effort", "fast", "--json",
                                          "--depfile", "d", "--roughness-in", "{dir}/rough/{stem}.png:r",
                                          "--roughness-out", "{stem}_{format}_{level}{ext}"});
    EXPECT_TRUE(scratch_.has("out/n.dds"));
    EXPECT_TRUE(scratch_.has("out/w_r8_0.png"));
    const auto report = nlohmann::json::parse(lines_of(out)[0]);
    EXPECT_EQ(report["output"], "out/n.dds");
    EXPECT_EQ(report["roughness"]["output"].size(), report["levels"].get<std::size_t>());
    EXPECT_EQ(report["roughness"]["output"][1], "out/n_r8_1.png");
    EXPECT_EQ(report["roughness"]["model"], "toksvig");
    const std::string depfile = scratch_.read("d");
    EXPECT_NE(depfile.find("./rough/n.png"), std::string::npos) << depfile;
    EXPECT_NE(depfile.find("out/n_r8_0.png"), std::string::npos) << depfile;
    // The base level is the map that was read.
    EXPECT_TRUE(same_red("h.png", "out/n_r8_0.png"));
}

// The engine builds the levels of the normals, which a picture does not hold, and not those of roughness.
TEST_F(RoughnessOut, HasItsLevelsBesideAPictureForAnEngine) {
    does("mip-normals", {"n.png", "-o", "n.dds", "--roughness-in", "0.3", "--roughness-out", "all.dds"});
    does("mip-normals",
         {"n.png", "-o", "for.png", "--for", "unreal", "--roughness-in", "0.3", "--roughness-out", "r.dds"});
    EXPECT_EQ(scratch_.read("r.dds"), scratch_.read("all.dds"));
    const auto levels = [&](const std::string& name) {
        return read_texture(scratch_.path(name)).value().levels.size();
    };
    EXPECT_EQ(levels("for.png"), 1u);
    EXPECT_EQ(levels("r.dds"), levels("n.dds"));
    does("mip-normals",
         {"n.png", "--out-dir", "out", "--for", "gltf", "--roughness-in", "0.3", "--roughness-out", "r_{level}.png"});
    EXPECT_TRUE(scratch_.has("out/r_1.png"));
}

TEST_F(RoughnessOut, MisuseIsRefused) {
    refuses({"--roughness-in", "0.5"}, 2, "--roughness-in does nothing without --roughness-out");
    refuses({"--roughness-out", ""}, 2, "--roughness-out");
    refuses({"--roughness-out", "-"}, 2, "needs a file, not standard output");
    refuses({"--roughness-out", "r.foo"}, 2, "r.foo: unsupported output format");
    refuses({"--roughness-out", "r.png"}, 2, "r.png: png files hold one level");
    refuses({"--roughness-out", "r.png", "--for", "unreal"}, 2,
            "png files hold one level, and the importer of unreal makes those of roughness: set Composite Texture");
    refuses({"--roughness-out", "r_{level}.png", "--roughness-format", "bc4"}, 2, "cannot hold roughness as bc4");
    refuses({"--roughness-out", "r.dds", "--roughness-format", "eac-r11"}, 2, "cannot hold roughness as eac-r11");
    refuses({"--roughness-out", "r_{stm}.png"}, 2, "did you mean stem?");
    refuses({"--roughness-out", "x.dds"}, 2, "two outputs of n.png are one file, x.dds");
    refuses({"--roughness-out", "h.png", "--mips", "none", "--roughness-in", "h.png"}, 2,
            "the output h.png is the input h.png");
    refuses({"--roughness-out", "r.dds", "--depfile", "r.dds"}, 2, "r.dds is an output");
    refuses({"--roughness-out", "r.dds", "--roughness-in", "1.5"}, 2, "1.5");
    refuses({"--roughness-out", "r.dds", "--roughness-in", "nan.png"}, 3, "nan.png: ");
    refuses({"--roughness-out", "r.dds", "--roughness-in", "waves.png:a"}, 4, "waves.png: ");
    refuses({"--roughness-out", "r.dds", "--roughness-model", "vfm"}, 2, "did you mean vmf?");
}

}  // namespace tex::cli
