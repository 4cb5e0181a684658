// SPDX-License-Identifier: Apache-2.0
// Maps whose colours were reduced to a palette, and maps that have few colours of their own.

#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace tex::cli {

class PaletteRule : public testing::Test {
protected:
    PaletteRule() {
        scratch_.add_sample("bricks.png", "bricks.png");
        EXPECT_EQ(shell(scratch_, "bake-normals bricks.png -o n.png --bumpiness 6 --no-sync --quiet").code, 0);
    }
    // The finding N317 of a file; null if there is none.
    nlohmann::json palette_of(const std::string& file) {
        const Ran ran = shell(scratch_, "check-normals " + file + " --json --quiet");
        const auto report = nlohmann::json::parse(ran.out);
        for (const auto& finding : report["findings"])
            if (finding["id"] == "N317") return finding;
        return {};
    }
    Scratch scratch_;
};

// Pillow chooses the colours, by three methods, and ImageMagick.
TEST_F(PaletteRule, NamesMapsOfFewColoursThatLieApart) {
    scratch_.write("reduce.py",
                   "from PIL import Image\n"
                   "image = Image.open('n.png').convert('RGB')\n"
                   "for method in (Image.Quantize.MEDIANCUT, Image.Quantize.MAXCOVERAGE, Image.Quantize.FASTOCTREE):\n"
                   "    for colors in (64, 200):\n"
                   "        small = image.quantize(colors, method=method)\n"
                   "        small.save(f'p{method}_{colors}.png')\n"
                   "        small.convert('RGB').save(f't{method}_{colors}.png')\n");
    ASSERT_EQ(shell(scratch_,
                    "/usr/bin/python3 reduce.py && convert n.png -colors 96 PNG24:m.png && "
                    "convert n.png +dither -colors 96 g.gif")
                  .code,
              0);
    EXPECT_TRUE(palette_of("n.png").is_null());
    for (const char* file : {"p0_64.png", "t0_200.png", "p1_64.png", "t1_200.png", "t2_64.png", "m.png", "g.gif"}) {
        const auto finding = palette_of(file);
        ASSERT_FALSE(finding.is_null()) << file;
        EXPECT_EQ(finding["severity"], "warning") << file;
        EXPECT_GT(finding["figure"], 1.0) << file;
    }
}

TEST_F(PaletteRule, AMapWithFewColoursOfItsOwnIsNone) {
    // Slopes along x alone, as of a roof of waves: 40 colours or so, one code apart, and flat facets that lie apart.
    scratch_.write(
        "own.py",
        "import math\n"
        "from PIL import Image\n"
        "def save(name, slopes):\n"
        "    image = Image.new('RGB', (128, 128))\n"
        "    for j in range(128):\n"
        "        for i in range(128):\n"
        "            p, q = slopes(i, j)\n"
        "            l = math.sqrt(p * p + q * q + 1)\n"
        "            image.putpixel((i, j), tuple(round(127.5 * c / l + 127.5) for c in (-p, -q, 1)))\n"
        "    image.save(name)\n"
        "save('waves.png', lambda i, j: (0.16 * math.sin(i / 128 * 2 * math.pi), 0))\n"
        "hashed = lambda k: (k * 2654435761 % 2**32) / 2**32 - 0.5\n"
        "save('facets.png', lambda i, j: (hashed(i // 21 + 7 * (j // 21)), hashed(i // 21 * 5 + j // 21 + 99)))\n");
    ASSERT_EQ(shell(scratch_, "/usr/bin/python3 own.py").code, 0);
    EXPECT_TRUE(palette_of("waves.png").is_null());
    EXPECT_TRUE(palette_of("facets.png").is_null());
}

// Maps that others published so.
TEST_F(PaletteRule, FindsPalettesOfOthers) {
    const std::string data = TEX_SOURCE_DIR "/../shared/data/", wild = data + "wild4/normal/";
    if (!std::filesystem::exists(wild)) GTEST_SKIP() << "no ../shared/data/wild4";
    for (const std::string& name : {data + "normal/nm_balls_256.png", wild + "godotdemos_texture_rock_normal.png"})
        EXPECT_FALSE(palette_of(name).is_null()) << name;
    // The first one's heights had 8 bits, so that its slopes lie on a lattice.
    for (const char* name : {"ogre_WaterNormal1.tga", "castle_wood_clear_normalmap.png", "tps_tile_steel_normal.png",
                             "usdwg_lava_flow_n.png", "godotdemos_checker_normal.png"})
        EXPECT_TRUE(palette_of(wild + name).is_null()) << name;
}

}  // namespace tex::cli
