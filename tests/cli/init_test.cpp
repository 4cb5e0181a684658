// SPDX-License-Identifier: Apache-2.0
// check-normals --classify and build-normals --init: what a tree of pictures holds, and a manifest for it.

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "tree/infer_rules.h"

namespace tex::cli {
namespace {

constexpr const char* kUp = "up";
constexpr const char* kDown = "down";

std::vector<InferredRule> rules_for(const std::vector<SettingsOfFile>& files) { return infer_rules(files); }

class Init : public testing::Test {
protected:
    Init() {
        for (const char* name : {"strip.png", "bricks.png", "dunes.png", "waves.png"}) scratch_.add_sample(name, name);
        for (const char* folder : {"art/deep", "art/pbr", "bought"})
            std::filesystem::create_directories(scratch_.path(folder));
        make("bake-normals strip.png -o art/wall_n.png --wrap clamp");
        make("bake-normals waves.png -o art/deep/floor_n.png");
        make("bake-normals bricks.png -o bought/brick_nrm.tga --y down");
        make("bake-normals dunes.png -o bought/dune_nrm.tga --y down");
        make(
            "pack-normals art/deep/floor_n.png -o art/pbr/wall_l.png --layout labpbr --blue waves.png --alpha "
            "waves.png");
        for (const char* name : {"art/wall_h.png", "art/dune_h.png"}) scratch_.add_sample("dunes.png", name);
    }
    void make(const std::string& line) { does(line + " --no-sync --quiet"); }
    void does(const std::string& line) {
        const Ran ran = shell(scratch_, line);
        ASSERT_EQ(ran.code, 0) << line << ": " << ran.err;
    }

    Scratch scratch_;
};

}  // namespace

TEST(InferRules, ThePatternIsAsWideAsTheTreeAllows) {
    const auto wide =
        rules_for({{"a/x_n.png", kUp, {}, false}, {"b/y_n.tga", kUp, {}, false}, {"b/y.png", "", {}, false}});
    ASSERT_EQ(wide.size(), 1u);
    EXPECT_EQ(wide[0].match, (std::vector<std::string>{"**/*_n.{png,tga}"}));
    const auto split = rules_for({{"a/x_n.png", kUp, {}, false},
                                  {"a/z_n.png", kUp, {}, false},
                                  {"b/y_n.png", kDown, {}, false},
                                  {"b/w_n.png", kDown, {}, false},
                                  {"b/v_n.png", kDown, {}, false}});
    ASSERT_EQ(split.size(), 2u);
    EXPECT_EQ(split[0].match, (std::vector<std::string>{"a/*_n.png"}));
    EXPECT_EQ(split[1].match, (std::vector<std::string>{"**/*_n.png"})) << "what is left of it";
    const auto folder = rules_for({{"n/a.png", kUp, {}, false}, {"n/b.png", kUp, {}, false}, {"a.png", "", {}, false}});
    EXPECT_EQ(folder[0].match, (std::vector<std::string>{"n/*.png"}));
}

TEST(InferRules, ExceptionsAreNamed) {
    const auto rules = rules_for({{"x_n.png", kUp, {}, false},
                                  {"y_n.png", kUp, {}, false},
                                  {"flat_n.png", "", {kUp, kDown}, false},
                                  {"bro[k]en_n.png", "", {}, true}});
    ASSERT_EQ(rules.size(), 1u);
    EXPECT_EQ(rules[0].exclude, (std::vector<std::string>{"bro\\[k\\]en_n.png"}));
    EXPECT_EQ(rules[0].files, (std::vector<std::string>{"x_n.png", "y_n.png", "flat_n.png"}));
    const auto single =
        rules_for({{"x_n.png", kUp, {}, false}, {"a_n.png", "", {}, false}, {"f.png", "", {kUp}, false}});
    ASSERT_EQ(single.size(), 1u);
    EXPECT_EQ(single[0].match, (std::vector<std::string>{"x_n.png", "f.png"}));
    EXPECT_TRUE(rules_for({{"a_n.png", "", {}, false}}).empty());
}

TEST(InferRules, TheEndOfANameSaysWhatItHolds) {
    EXPECT_EQ(name_end("a/rock_n.png"), "_n");
    EXPECT_EQ(name_end("a.b/rockNormal.tga"), "Normal");
    EXPECT_EQ(name_end("rock-normal-gl.png"), "-gl");
    for (const char* none : {"rock.png", "Rock.png", "rock_01.png", "_.png", "a.b/c"})
        EXPECT_EQ(name_end(none), "") << none;
    EXPECT_EQ(name_beginning("a/rock_n.png"), "a/rock");
}

TEST_F(Init, ClassifySaysWhatPicturesHold) {
    scratch_.add_sample("report.png", "colour.png");
    const Ran ran =
        shell(scratch_, "check-normals --classify art/wall_n.png bought/brick_nrm.tga art/wall_h.png colour.png");
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_NE(ran.out.find("normals       rgb      up    1.00  rgb8-unorm"), std::string::npos) << ran.out;
    EXPECT_NE(ran.out.find("normals       rgb      down  1.00  rgb8-unorm  512x512     1  bought/brick_nrm.tga"),
              std::string::npos)
        << ran.out;
    EXPECT_NE(ran.out.find("grey          -        -     1.00  r8-unorm "), std::string::npos) << ran.out;
    EXPECT_NE(ran.out.find("colour        -        -"), std::string::npos) << ran.out;
    EXPECT_NE(ran.out.find("4 files: 2 normals (green up in 1, down, or red left, in 1), 1 grey, 1 colour"),
              std::string::npos)
        << ran.out;
    const Ran json = shell(scratch_, "check-normals --classify --json art/wall_n.png");
    EXPECT_EQ(nlohmann::json::parse(json.out.substr(0, json.out.find('\n')))["kind"], "normals");
    scratch_.write("no.png", "no picture");
    const Ran broken = shell(scratch_, "check-normals --classify no.png art/wall_n.png");
    EXPECT_EQ(broken.code, 4);
    EXPECT_NE(broken.out.find("unknown       -        -     -     -           -           -  no.png: "),
              std::string::npos)
        << broken.out;
    EXPECT_NE(broken.err.find("error: no.png: "), std::string::npos) << broken.err;
    EXPECT_EQ(shell(scratch_, "check-normals --classify art/wall_n.png --report r.html").code, 2);
}

// A cone of 900 m, as map servers send heights.
TEST_F(Init, MapTilesAreHeightsInBytes) {
    scratch_.write("tiles.py",
                   "from PIL import Image\n"
                   "a, b = Image.new('RGB', (128, 128)), Image.new('RGB', (128, 128))\n"
                   "for y in range(128):\n"
                   "    for x in range(128):\n"
                   "        h = 1500 - 10 * ((x - 64) ** 2 + (y - 64) ** 2) ** 0.5\n"
                   "        t, m = int((h + 32768) * 256), int((h + 10000) * 10)\n"
                   "        a.putpixel((x, y), (t >> 16, t >> 8 & 255, t & 255))\n"
                   "        b.putpixel((x, y), (m >> 16, m >> 8 & 255, m & 255))\n"
                   "a.save('land/terrarium.png')\n"
                   "b.save('land/terrain-rgb.png')\n");
    std::filesystem::create_directories(scratch_.path("land"));
    ASSERT_EQ(shell(scratch_, "/usr/bin/python3 tiles.py").code, 0);
    for (const std::string channel : {"terrarium", "terrain-rgb"}) {
        SCOPED_TRACE(channel);
        const std::string file = "land/" + channel + ".png";
        const Ran kind = shell(scratch_, "check-normals --classify " + file);
        EXPECT_EQ(kind.out.rfind("heights       " + channel, 0), 0u) << kind.out;
        const std::string fix = "bake-normals " + file + " --channel " + channel + " --bumpiness auto";
        EXPECT_NE(shell(scratch_, "check-normals " + file).out.find("fix: " + fix), std::string::npos);
        const std::string bake = "bake-normals " + file + " --no-sync ";
        const Ran found = shell(scratch_, bake + "-o found.exr");
        EXPECT_NE(found.out.find("--channel " + channel + ": R, G and B are the bytes of heights"), std::string::npos)
            << found.out;
        EXPECT_EQ(shell(scratch_, bake + "-o named.exr --channel " + channel).code, 0);
        EXPECT_EQ(scratch_.read("found.exr"), scratch_.read("named.exr"));
        EXPECT_EQ(shell(scratch_, bake + "-o luma.exr --channel luma").out, "");
        const Ran fixed = shell(scratch_, fix + " --format rgb8 -o fixed.png --no-sync");
        EXPECT_EQ(fixed.code, 0) << fixed.err;
        EXPECT_EQ(shell(scratch_, "check-normals fixed.png").code, 0);
    }
    // What bake-normals says if nothing states the width of the land.
    const Ran assumed = shell(scratch_, "bake-normals land/terrarium.png --channel terrarium -o t.png --no-sync");
    EXPECT_NE(assumed.err.find("--height-range 1 --world-size W"), std::string::npos) << assumed.err;
    EXPECT_EQ(shell(scratch_,
                    "bake-normals land/terrarium.png --channel terrarium -o t.png --height-range 1 "
                    "--world-size 1280 --no-sync")
                  .err,
              "");
    EXPECT_EQ(shell(scratch_, "build-normals --init").code, 0);
    const std::string manifest = scratch_.read("normals.toml");
    EXPECT_NE(manifest.find("channel = \"terrarium\""), std::string::npos) << manifest;
    EXPECT_EQ(shell(scratch_, "build-normals --no-sync").code, 0);
    const Ran again = shell(scratch_, "build-normals --no-sync --json");
    EXPECT_NE(again.out.find("\"up_to_date\":[\"build/textures/land/terrarium"), std::string::npos) << again.out;
}

// Their texels have a size, so that the slopes are known.
TEST_F(Init, ElevationModelsKeepTheSlopesOfTheGround) {
    std::filesystem::remove_all(scratch_.path("art"));
    std::filesystem::create_directories(scratch_.path("land"));
    std::string grid = "ncols 48\nnrows 48\nxllcorner 500000\nyllcorner 5100000\ncellsize 30\n";
    for (int k = 0; k < 48 * 48; ++k) grid += std::to_string(300 + k * k % 211) + (k % 48 == 47 ? "\n" : " ");
    scratch_.write("land/alps.asc", grid);
    make("build-normals --init");
    const std::string manifest = scratch_.read("normals.toml");
    EXPECT_NE(manifest.find("match = \"land/alps.asc\"\nsteps = [ { bake = {} } ]"), std::string::npos) << manifest;
}

// A slope that ends is steeper at the border than anywhere: the rule says so, and the build has nothing to warn of.
TEST_F(Init, HeightsThatDoNotRepeatAreClamped) {
    std::filesystem::create_directories(scratch_.path("hills"));
    does(
        "convert -size 128x128 -depth 16 gradient: waves.png -resize 128x128! -evaluate multiply 0.5 -compose plus "
        "-composite hills/slope_h.png");
    const std::string heights = scratch_.read("hills/slope_h.png");
    does("build-normals --init --quiet");
    EXPECT_EQ(scratch_.read("hills/slope_h.png"), heights);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(scratch_.path("hills")), {}), 1) << "nothing else";
    const std::string manifest = scratch_.read("normals.toml");
    EXPECT_NE(manifest.find("{ bake = { bumpiness = \"auto\", wrap = \"clamp\" } }"), std::string::npos) << manifest;
    const Ran built = shell(scratch_, "build-normals --no-sync");
    EXPECT_EQ(built.code, 0) << built.err;
    EXPECT_EQ(built.err.find("a wall along the border"), std::string::npos) << built.err;
}

// Faults keep rules away, and the error says which; exchanged channels need no other space.
TEST_F(Init, FaultsAreTheReasonWhyNothingIsWritten) {
    does(
        "bake-normals bricks.png --bumpiness 8 -o rough_n.png --no-sync --quiet; "
        "convert rough_n.png -separate -swap 0,2 -combine PNG24:bgr.png; rm rough_n.png");
    const Ran kind = shell(scratch_, "check-normals --classify bgr.png");
    EXPECT_EQ(kind.out.rfind("normals ", 0), 0u) << kind.out;
    does("mkdir faulty; mv bgr.png faulty; head -c 500 art/wall_n.png > faulty/torn.png");
    const Ran none = shell(scratch_, "cd faulty; build-normals --init");
    EXPECT_EQ(none.code, 4);
    EXPECT_NE(none.err.find("no rule can be for any of them: bgr.png (normals, in which check-normals finds errors), "
                            "torn.png (cannot be decoded)"),
              std::string::npos)
        << none.err;
}

// Models are no textures of a tree, and their maps are checked all the same.
TEST_F(Init, ModelsAreCounted) {
    does("touch art/a.glb bought/b.GLTF");
    const Ran ran = shell(scratch_, "build-normals --init");
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_NE(ran.out.find("models without a rule: 2; check-normals and repair-normals take their maps"),
              std::string::npos)
        << ran.out;
}

// Stripes show no direction of green; the X-Ray engine has x, y and z in A, B and G.
TEST_F(Init, GuessesAreMarked) {
    ASSERT_EQ(shell(scratch_,
                    "convert -size 128x128 gradient: -rotate 90 -function Sinusoid 8,0 -depth 8 stripes.png && "
                    "bake-normals stripes.png -o bought/stripes_nrm.tga --bumpiness 20 --no-sync && mkdir xray && "
                    "convert art/wall_n.png '(' -clone 0 -channel B -separate ')' "
                    "'(' -clone 0 -channel G -separate ')' "
                    "'(' -clone 0 -channel R -separate ')' -delete 0 '(' -size 920x250 gradient:gray20-gray80 ')' "
                    "+insert -channel RGBA -combine -depth 8 PNG32:xray/wall_bump.png")
                  .code,
              0);
    EXPECT_EQ(shell(scratch_, "build-normals --init").code, 0);
    const std::string manifest = scratch_.read("normals.toml");
    SCOPED_TRACE(manifest);
    const std::string guess = "whose texels do not show for sure where green points:\n";
    EXPECT_NE(manifest.find(guess + "#     bought/stripes_nrm.tga\n"), std::string::npos);
    const std::string down = "  \"bought/stripes_nrm.tga\",\n]\nsteps = [ { pack = { y-in = \"down\" } } ]";
    EXPECT_TRUE(manifest.find(down) != std::string::npos ||
                manifest.find("**/*_nrm.tga\"\nsteps = [ { pack = { y-in = \"down\" } } ]") != std::string::npos)
        << "as the others in its folder";
    EXPECT_NE(manifest.find("swizzle = \"abg\""), std::string::npos);
    EXPECT_NE(manifest.find("is left out (drop).\n"), std::string::npos);
}

TEST_F(Init, TheFirstBuildAndTheFirstCheckPass) {
    scratch_.write("art/broken_n.png", "no picture");
    scratch_.add_sample("report.png", "art/colour.png");
    scratch_.add_sample("waves.png", "art/bad\xff_h.png");  // a name that no TOML may hold
    const Ran ran = shell(scratch_, "build-normals --init");
    ASSERT_EQ(ran.code, 0) << ran.err;
    const std::string manifest = scratch_.read("normals.toml");
    SCOPED_TRACE(manifest);
    EXPECT_NE(manifest.find("match = \"**/*_nrm.tga\"\nsteps = [ { pack = { y-in = \"down\" } } ]"), std::string::npos);
    EXPECT_NE(manifest.find("\"**/*_n.png\""), std::string::npos);
    EXPECT_NE(manifest.find("y-in = \"down\", swizzle = \"rg\", drop = true"), std::string::npos) << "LabPBR";
    EXPECT_NE(manifest.find("#     art/wall_h.png\n"), std::string::npos) << "there is a normal map beside it";
    EXPECT_NE(manifest.find("#     art/broken_n.png\n"), std::string::npos);
    const Ran built = shell(scratch_, "build-normals --no-sync");
    EXPECT_EQ(built.code, 0) << built.err;
    for (const char* name : {"art/wall_n", "art/deep/floor_n", "bought/brick_nrm", "art/pbr/wall_l", "art/dune_h"})
        EXPECT_TRUE(scratch_.has(std::string("build/textures/") + name + ".dds")) << name;
    EXPECT_EQ(shell(scratch_, "check-normals --baseline normals-baseline.json bought/*.tga art/wall_n.png").code, 0);
    // What the comment in the manifest says of engines.
    const std::string outputs = "{ format = \"bc5\", y = \"up\", mips = \"all\" }";
    ASSERT_NE(manifest.find(outputs), std::string::npos);
    std::string engine = manifest;
    scratch_.write("unity.toml", engine.replace(engine.find(outputs), outputs.size(), "{ for = \"unity\" }"));
    const Ran for_unity = shell(scratch_, "build-normals unity.toml --no-sync");
    EXPECT_EQ(for_unity.code, 0) << for_unity.err;
    EXPECT_TRUE(scratch_.has("build/textures/art/wall_n.png"));
    std::filesystem::remove_all(scratch_.path("build"));
    EXPECT_EQ(shell(scratch_, "build-normals --no-sync --quiet").code, 0);
    // The commands that it prints: the whole tree passes, with its colours and heights and with what was built.
    EXPECT_NE(ran.out.find("next: build-normals --dry-run shows"), std::string::npos) << ran.out;
    EXPECT_EQ(shell(scratch_, "build-normals --dry-run").code, 0);
    EXPECT_NE(ran.out.find("check-normals . --baseline normals-baseline.json"), std::string::npos) << ran.out;
    std::filesystem::remove(scratch_.path("art/broken_n.png"));
    const Ran whole = shell(scratch_, "check-normals . --baseline normals-baseline.json");
    EXPECT_EQ(whole.code, 0) << whole.out << whole.err;
    // Neither file is replaced.
    const Ran again = shell(scratch_, "build-normals --init");
    EXPECT_EQ(again.code, 3);
    EXPECT_NE(again.err.find("normals.toml: is there already"), std::string::npos) << again.err;
    EXPECT_EQ(scratch_.read("normals.toml"), manifest);
    const Ran other = shell(scratch_, "build-normals other.toml --init");
    EXPECT_EQ(other.code, 3);
    EXPECT_FALSE(scratch_.has("other.toml"));
}

TEST_F(Init, AMissingManifestNamesTheOption) {
    const Ran ran = shell(scratch_, "build-normals");
    EXPECT_EQ(ran.code, 3);
    EXPECT_NE(ran.err.find("normals.toml: "), std::string::npos);
    EXPECT_NE(ran.err.find("build-normals --init writes one"), std::string::npos) << ran.err;
    EXPECT_EQ(shell(scratch_, "build-normals --init --dry-run").code, 2);
    std::filesystem::create_directories(scratch_.path("empty"));
    const Ran empty = shell(scratch_, "cd empty && build-normals --init");
    EXPECT_EQ(empty.code, 4);
    EXPECT_NE(empty.err.find("nothing is written: no picture is below this folder"), std::string::npos) << empty.err;
    EXPECT_FALSE(scratch_.has("empty/normals.toml"));
}

// Blue holds occlusion, and alpha heights: x and y alone are judged.
TEST_F(Init, ALayoutCanBeGiven) {
    const Ran given = shell(scratch_, "check-normals --swizzle labpbr --json art/pbr/wall_l.png");
    EXPECT_EQ(given.code, 0) << given.out;
    const auto report = nlohmann::json::parse(given.out.substr(0, given.out.find('\n')));
    EXPECT_EQ(report["swizzle"], "rg");
    EXPECT_TRUE(std::none_of(report["findings"].begin(), report["findings"].end(), [](const auto& finding) {
        return finding["severity"] != "note";
    })) << given.out;
    scratch_.write("c.toml", "[[rule]]\nmatch = \"**/pbr/*\"\nswizzle = \"labpbr\"\n");
    const Ran ruled = shell(scratch_, "check-normals --config c.toml --json art/pbr/wall_l.png");
    EXPECT_EQ(without_seconds(ruled.out), without_seconds(given.out));
    // Colours are no normals in this layout, either.
    scratch_.add_sample("report.png", "colour.png");
    EXPECT_EQ(shell(scratch_, "check-normals --swizzle labpbr colour.png").code, 1);
    EXPECT_EQ(shell(scratch_, "check-normals --swizzle nonsense colour.png").code, 2);
    const Ran lacking = shell(scratch_, "check-normals --swizzle dxt5nm bought/brick_nrm.tga");
    EXPECT_EQ(lacking.code, 4);
    EXPECT_NE(lacking.err.find("reads A, which is not there"), std::string::npos) << lacking.err;
}

}  // namespace tex::cli
