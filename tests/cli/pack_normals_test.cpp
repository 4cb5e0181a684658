// SPDX-License-Identifier: Apache-2.0

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tex/tex.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "cli/unmarked.h"

namespace tex::cli {

class PackNormals : public testing::Test {
protected:
    PackNormals() {
        scratch_.add_sample("waves.png", "waves.png");
        does("bake-normals", {"waves.png", "-o", "n.dds", "--bumpiness", "12", "--format", "float"});
    }
    Ran go(const std::string& command, std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), {"--no-sync"});
        return run(scratch_, command, arguments);
    }
    void does(const std::string& command, const std::vector<std::string>& arguments, const std::string& said = {}) {
        const Ran ran = go(command, arguments);
        EXPECT_EQ(ran.code, 0) << command << " " << arguments[0] << ": " << ran.err;
        if (said.empty()) {
            const bool is_noise = ran.err.find("as in object space") != std::string::npos ||
                                  ran.err.find("is not the z of its red") != std::string::npos ||
                                  ran.err.find("this is no normal map") != std::string::npos ||
                                  ran.err.find("one level is written") != std::string::npos ||
                                  ran.err.find("nearly flat") != std::string::npos;  // as some inputs are
            EXPECT_TRUE(ran.err.empty() || is_noise) << ran.err;
        }
        EXPECT_NE(ran.err.find(said), std::string::npos) << ran.err;
    }
    std::string_view format_of(const std::string& name) {
        const auto texture = read_texture(scratch_.path(name));
        EXPECT_TRUE(texture) << name;
        return texture ? name_of(kFormatNames, texture->format) : std::string_view();
    }
    // The largest and the mean angle between the base levels of two files, in degrees.
    AngularError distance(const std::string& a, const std::string& b) {
        const auto map = [&](const std::string& name) {
            auto texture = read_texture(scratch_.path(name));
            EXPECT_TRUE(texture) << name;
            auto swizzle = guess_swizzle(*texture);
            EXPECT_TRUE(swizzle) << name;
            UnpackOptions options;
            options.swizzle = *swizzle;
            auto chain = unpack(*texture, options);
            EXPECT_TRUE(chain) << name;
            return std::move(chain->levels.front());
        };
        const NormalMap first = map(a), second = map(b);
        const auto compared = compare(first, second);
        EXPECT_TRUE(compared);
        return compared->error;
    }
    Scratch scratch_;
};

TEST_F(PackNormals, EveryEncodingComesBackWithinItsQuantisation) {
    // Degrees: the largest error over 128x128 texels with a tilt of up to about 50 degrees.
    const std::pair<const char*, double> bounds[] = {
        {"dxt5nm", 12.0}, {"bc5", 4.0}, {"bc5-snorm", 4.0}, {"rgb8", 0.6}, {"rgba8", 0.6},   {"rgb16", 0.01},
        {"ag8", 1.0},     {"rg8", 1.0}, {"rg16", 0.01},     {"half", 0.1}, {"float", 0.0001}};
    for (const auto& [encoding, bound] : bounds) {
        for (const std::string name : {"x.dds", "x.ktx2"}) {
            does("pack-normals", {"n.dds", "-o", name, "--format", encoding});
            const AngularError error = distance("n.dds", name);
            EXPECT_LE(error.max, bound) << encoding;
        }
    }
}

// All commands read and write EAC, in KTX2 alone.
TEST_F(PackNormals, EacGoesIntoKtx2) {
    for (const std::string encoding : {"eac-rg11", "eac-rg11-snorm"}) {
        for (const std::string effort : {"fast", "normal", "best"}) {
            does("pack-normals", {"n.dds", "-o", "e.ktx2", "--format", encoding, "--effort", effort, "--y", "up"});
            EXPECT_LE(distance("n.dds", "e.ktx2").max, 4.0) << encoding << " " << effort;
        }
        const auto report = nlohmann::json::parse(
            go("pack-normals", {"e.ktx2", "-o", "again.ktx2", "--format", encoding, "--effort", "best", "--json"}).out);
        EXPECT_EQ(report["format"], encoding);
        EXPECT_LE(distance("e.ktx2", "again.ktx2").max, 0.01) << "blocks are found again";
        EXPECT_EQ(run(scratch_, "check-normals", {"e.ktx2", "--require", "format=" + encoding}).code, 0);
        EXPECT_EQ(run(scratch_, "check-normals", {"e.ktx2", "--require", "format=bc5"}).code, 1);
        EXPECT_EQ(run(scratch_, "check-normals", {"e.ktx2", "--report", "report.html"}).code, 0);
        EXPECT_EQ(run(scratch_, "compare-normals", {"n.dds", "e.ktx2", "--max-mean", "1"}).code, 0);
        does("preview-normals", {"e.ktx2", "-o", "lit.png"});
        does("unpack-normals", {"e.ktx2", "-o", "u.png", "--format", "rgb16"});
        does("mip-normals", {"e.ktx2", "-o", "m.ktx2", "--format", encoding, "--supercompress", "zstd"});
        does("scale-normals", {"e.ktx2", "-o", "s.ktx2", "--scale", "0.5", "--format", encoding});
        does("blend-normals", {"e.ktx2", "--detail", "n.dds", "-o", "b.ktx2", "--format", encoding});
        does("bake-normals", {"waves.png", "-o", "w.ktx2", "--format", encoding});
        // Nothing but the order of BC5 is in doubt.
        does("pack-normals", {"e.ktx2", "-o", "o.ktx2", "--format", "rgb16", "--bc5-order", "yx"});
        EXPECT_LE(distance("e.ktx2", "o.ktx2").max, 0.1);
        const Ran refused = go("pack-normals", {"n.dds", "-o", "e.dds", "--format", encoding});
        EXPECT_EQ(refused.code, 2);
        EXPECT_NE(refused.err.find("dds files cannot hold " + encoding), std::string::npos) << refused.err;
        EXPECT_NE(refused.err.find(encoding + " goes into .ktx2"), std::string::npos) << refused.err;
        does("pack-normals", {"e.ktx2", "-o", "d.dds"});
        EXPECT_EQ(read_texture(scratch_.path("d.dds"))->format, Format::bc3_unorm) << "the default of DDS";
    }
}

TEST_F(PackNormals, LevelsAreKeptUnlessOthersAreAskedFor) {
    const auto levels = [&](std::vector<std::string> arguments) {
        arguments.push_back("--json");
        return nlohmann::json::parse(go("pack-normals", arguments).out)["levels"].get<int>();
    };
    EXPECT_EQ(levels({"n.dds", "-o", "x.ktx2"}), 8);
    EXPECT_EQ(levels({"n.dds", "-o", "x.png"}), 1);
    EXPECT_EQ(levels({"n.dds", "-o", "x.ktx2", "--mips", "none"}), 1);
    EXPECT_EQ(levels({"n.dds", "-o", "x.ktx2", "--mips", "3"}), 3);
    EXPECT_EQ(levels({"x.png", "-o", "y.dds"}), 1);
    EXPECT_EQ(levels({"x.png", "-o", "y.dds", "--mips", "all"}), 8);
    EXPECT_EQ(levels({"n.dds", "-o", "small.ktx2", "--max-size", "20"}), 5);
    EXPECT_EQ(read_texture(scratch_.path("small.ktx2"))->extent(), (Extent{16, 16}));
    EXPECT_EQ(levels({"n.dds", "-o", "small.dds", "--max-size", "20", "--mips", "2"}), 2);
    EXPECT_EQ(levels({"n.dds", "-o", "small.png", "--max-size", "20"}), 1);
    EXPECT_EQ(read_image(scratch_.path("small.png"))->extent(), (Extent{16, 16}));
    EXPECT_EQ(levels({"x.png", "-o", "built.dds", "--max-size", "20"}), 1) << "the picture has no level to keep";
    EXPECT_EQ(read_texture(scratch_.path("built.dds"))->extent(), (Extent{16, 16}));
    // Kept levels are the file's own levels, not new ones.
    does("mip-normals", {"n.dds", "-o", "faded.dds", "--format", "float", "--fade", "0,1"});
    does("pack-normals", {"faded.dds", "-o", "faded.ktx2", "--format", "float", "--keep-length"});
    does("pack-normals", {"faded.ktx2", "-o", "again.dds", "--format", "float", "--keep-length"});
    EXPECT_TRUE(scratch_.read("again.dds") == scratch_.read("faded.dds"));
    const Ran idle = go("pack-normals", {"n.dds", "-o", "z.dds", "--fade", "1,3"});
    EXPECT_EQ(idle.code, 2);
    EXPECT_NE(idle.err.find("--fade does nothing if levels are kept"), std::string::npos) << idle.err;
}

TEST_F(PackNormals, BlocksThatBecomeTheDefaultEncodingAreNamed) {
    does("pack-normals", {"n.dds", "-o", "b.dds", "--format", "bc5"});
    does("pack-normals", {"b.dds", "-o", "c.dds", "--y", "down"},
         "bc5 becomes dxt5nm, the default; --format keep keeps it");
    does("pack-normals", {"b.dds", "-o", "d.dds", "--y", "down", "--format", "keep"});
    EXPECT_EQ(format_of("d.dds"), "bc5-unorm");
    does("pack-normals", {"b.dds", "-o", "e.dds", "--format", "dxt5nm"});
    does("unpack-normals", {"b.dds", "-o", "f.dds"});
}

TEST_F(PackNormals, KeepStoresEachFileOfAFolderAsItWas) {
    const std::pair<std::string, std::string> kinds[] = {
        {"a.dds", "bc5"}, {"b.dds", "rgba8"}, {"c.dds", "dxt5nm"}, {"d.ktx2", "bc7"}, {"e.png", "rgb16"}};
    std::vector<std::string> names;
    for (const auto& [name, format] : kinds) {
        does("pack-normals", {"n.dds", "-o", name, "--format", format});
        names.push_back(name);
    }
    std::vector<std::string> args = names;
    args.insert(args.end(), {"--out-dir", "flipped", "--y-in", "up", "--y", "down", "--format", "keep"});
    does("pack-normals", args);
    for (const std::string& name : names) EXPECT_EQ(format_of("flipped/" + name), format_of(name)) << name;
    args = names;
    args.insert(args.end(), {"--out-dir", "levels", "--format", "keep", "--mips", "none"});
    does("mip-normals", args);
    for (const std::string& name : names) EXPECT_EQ(format_of("levels/" + name), format_of(name)) << name;
    // Texels go into blocks as always, because a picture is no texture.
    does("pack-normals", {"e.png", "-o", "f.dds", "--format", "keep"});
    EXPECT_EQ(format_of("f.dds"), "bc3-unorm");
    const Ran unknown =
        go("pack-normals", {"a.dds", "--out-dir", "x", "--name", "{stem}_{format}.dds", "--format", "keep"});
    EXPECT_EQ(unknown.code, 2);
    EXPECT_NE(unknown.err.find("{format} in a name needs a --format other than keep"), std::string::npos)
        << unknown.err;
}

TEST_F(PackNormals, FlippingTwiceGivesTheSameWhereLengthsAreKept) {
    does("pack-normals", {"n.dds", "-o", "up.png"});
    does("pack-normals", {"up.png", "-o", "down.png", "--y", "down", "--keep-length"});
    does("pack-normals", {"down.png", "-o", "again.png", "--y-in", "down", "--y", "up", "--keep-length"});
    EXPECT_FALSE(scratch_.read("down.png") == scratch_.read("up.png"));
    EXPECT_TRUE(scratch_.read("up.png") == scratch_.read("again.png"));
}

// The texels of a picture as ImageMagick reads them: R, G and B in turn.
std::vector<std::uint16_t> codes_of(const Scratch& scratch, const std::string& name, int bits) {
    const Ran ran = shell(scratch, "convert '" + name + "' -depth " + std::to_string(bits) + " -endian LSB rgb:codes");
    EXPECT_EQ(ran.code, 0) << ran.err;
    const std::string bytes = scratch.read("codes");
    std::vector<std::uint16_t> codes;
    for (std::size_t k = 0; k < bytes.size(); k += bits == 8 ? 1 : 2) {
        const auto byte = [&](std::size_t at) { return static_cast<unsigned>(static_cast<unsigned char>(bytes[at])); };
        codes.push_back(static_cast<std::uint16_t>(bits == 8 ? byte(k) : byte(k) + 256 * byte(k + 1)));
    }
    return codes;
}

// A shader flips green by 1 - g, and so does every converter from DirectX to OpenGL.
TEST_F(PackNormals, FlippingGreenKeepsAllOtherCodes) {
    for (const int bits : {8, 16}) {
        // Every code of green, and vectors of any length.
        Texture texture;
        texture.format = bits == 8 ? Format::rgb8_unorm : Format::rgb16_unorm;
        texture.levels.push_back({{256, 256}, {}});
        for (unsigned k = 0; k < 65536; ++k) {
            for (const unsigned code : {k * 40503 >> 3, k, k * 25173 >> 5}) {
                if (bits == 16) texture.levels.front().bytes.push_back(static_cast<std::byte>(code));
                texture.levels.front().bytes.push_back(static_cast<std::byte>(bits == 16 ? code >> 8 : code));
            }
        }
        ASSERT_TRUE(write_texture(scratch_.path("a.png"), texture));
        const unsigned top = bits == 8 ? 255 : 65535;
        const auto before = codes_of(scratch_, "a.png", bits);
        const std::string format = bits == 8 ? "rgb8" : "rgb16";
        for (const std::string way : {"a.png -o b.png", "a.png -o b.dds", "b.dds -o c.png --y-in up"}) {
            SCOPED_TRACE(way);
            const bool is_back = way.starts_with("b");
            const Ran ran = shell(scratch_, "pack-normals " + way + (is_back ? "" : " --y-in down") +
                                                (is_back ? " --y down" : " --y up") + " --no-sync --format " + format +
                                                (is_back ? " && mv c.png b.png" : ""));
            ASSERT_EQ(ran.code, 0) << ran.err;
            if (way.ends_with("dds")) continue;
            auto expected = before;
            for (std::size_t k = 1; k < expected.size() && !is_back; k += 3)
                expected[k] = static_cast<std::uint16_t>(top - expected[k]);
            EXPECT_TRUE(codes_of(scratch_, "b.png", bits) == expected);
        }
        does("pack-normals", {"a.png", "-o", "unit.png", "--y-in", "down", "--y", "up", "--normalize"});
        EXPECT_FALSE(codes_of(scratch_, "unit.png", bits) == before);
    }
    // Only where the codes can stay: blocks, other depths and built levels get unit vectors, as with --normalize.
    for (const std::string options :
         {"-o x.dds --format dxt5nm", "-o x.dds --format rg16", "-o x.exr", "-o x.dds --format rgb16 --mips all"}) {
        const Ran ran = shell(scratch_, "pack-normals a.png --no-sync " + options +
                                            " && mv x.* 1 && pack-normals a.png --normalize --no-sync " + options +
                                            " && cmp x.* 1 && rm x.*");
        EXPECT_EQ(ran.code, 0) << options << ran.out << ran.err;
    }
    const Ran both = go("pack-normals", {"a.png", "-o", "x.png", "--normalize", "--keep-length"});
    EXPECT_EQ(both.code, 2);
}

// The outputs of a rule come from one reading, but each has the bytes that it has alone.
TEST_F(PackNormals, OutputsThatAreMadeTogetherKeepTheirOwnCodes) {
    ASSERT_EQ(shell(scratch_,
                    "convert -size 64x64 -seed 1 xc: +noise Random -type TrueColor -depth 8 -strip a_n.png && "
                    "printf 'version = 1\n[[rule]]\nmatch = \"a_n.png\"\nsteps = [ { pack = {} } ]\n"
                    "check = { inputs = false }\noutputs = [ { name = \"o/rgb.png\", y = \"down\" }, { name = "
                    "\"o/bc5.dds\", format = "
                    "\"bc5\" }, { name = \"o/f.exr\" } ]\n' > normals.toml && build-normals --no-sync")
                  .code,
              0);
    does("pack-normals", {"a_n.png", "-o", "rgb.png", "--y", "down"});
    does("pack-normals", {"a_n.png", "-o", "bc5.dds", "--format", "bc5"});
    does("pack-normals", {"a_n.png", "-o", "f.exr"});
    for (const std::string name : {"rgb.png", "bc5.dds", "f.exr"})
        EXPECT_TRUE(scratch_.read("o/" + name) == scratch_.read(name)) << name;
    auto codes = codes_of(scratch_, "a_n.png", 8);
    for (std::size_t k = 1; k < codes.size(); k += 3) codes[k] = static_cast<std::uint16_t>(255 - codes[k]);
    EXPECT_TRUE(codes_of(scratch_, "o/rgb.png", 8) == codes);
}

TEST_F(PackNormals, LayoutsWithoutAMarkAreToldFromTheirTexels) {
    does("pack-normals", {"n.dds", "-o", "ag.png", "--format", "ag8"});
    remove_marks(scratch_, "ag.png");
    does("pack-normals", {"ag.png", "-o", "guessed.dds", "--format", "float"},
         "ag.png: layout not stated; guessed dxt5nm from the texels");
    does("pack-normals", {"ag.png", "-o", "told.dds", "--format", "float", "--swizzle", "dxt5nm"});
    does("pack-normals", {"ag.png", "-o", "either.dds", "--format", "float", "--swizzle", "rgorag"});
    EXPECT_TRUE(scratch_.read("guessed.dds") == scratch_.read("told.dds"));
    EXPECT_TRUE(scratch_.read("either.dds") == scratch_.read("told.dds"));
    EXPECT_LT(distance("n.dds", "told.dds").max, 1.0);
    does("pack-normals", {"n.dds", "-o", "rgb.png", "--format", "rgba8"});
    does("pack-normals", {"rgb.png", "-o", "rgb.dds", "--format", "float"});
    EXPECT_LT(distance("n.dds", "rgb.dds").max, 0.6);
    std::filesystem::copy_file(scratch_.path("ag.png"), scratch_.path("more.png"));
    const Ran many =
        go("pack-normals", {"rgb.png", "ag.png", "more.png", "--out-dir", "out", "--mips", "keep", "--json"});
    EXPECT_EQ(many.err,
              "pack-normals: warning: ag.png and 1 more: layout not stated; guessed dxt5nm from the "
              "texels (A varies; R and B are constant, or R, G and B are equal); --swizzle sets it\n");
    EXPECT_EQ(nlohmann::json::parse(lines_of(many.out).at(1))["source"]["swizzle"], "dxt5nm");
    const Ran wrong = go("pack-normals", {"n.dds", "-o", "z.dds", "--swizzle", "dxt5n"});
    EXPECT_EQ(wrong.code, 2);
    EXPECT_NE(wrong.err.find("did you mean dxt5nm?"), std::string::npos) << wrong.err;
}

TEST_F(PackNormals, ASwizzleThatTheFileLacksIsAMatterOfTheFile) {
    does("pack-normals", {"n.dds", "-o", "rgb.png"});
    const Ran ran = go("pack-normals", {"rgb.png", "-o", "z.dds", "--swizzle", "dxt5nm"});
    EXPECT_EQ(ran.code, 4);
    EXPECT_EQ(lines_of(ran.err).size(), 1u) << ran.err;
}

}  // namespace tex::cli
