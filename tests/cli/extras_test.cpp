// SPDX-License-Identifier: Apache-2.0
// --blue, --alpha, --length, --kind, --layout, --blue-out, --alpha-out, --length-in, --length-out: data beside the
// normals, from file to file.

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/tex.h>

#include "cli/meshes.h"
#include "cli/program.h"

namespace tex::cli {
namespace {

class Extras : public testing::Test {
protected:
    Extras() {
        std::filesystem::copy_file(TEX_SOURCE_DIR "/samples/bricks.png", scratch_.path("h.png"));
        run("bake-normals h.png -o n.png --bumpiness 6");
        run("preview-normals n.png -o ao.png --show lit --size 512 --no-legend");
    }
    void run(const std::string& line) const {
        const Ran ran = shell(scratch_, line + " --no-sync --quiet");
        ASSERT_EQ(ran.code, 0) << line << '\n' << ran.err;
    }
    void refuses(const std::string& line, int code, const std::string& words) {
        const auto before = scratch_.list();
        const Ran ran = shell(scratch_, line);
        EXPECT_EQ(ran.code, code) << line << '\n' << ran.err;
        EXPECT_NE(ran.err.find(words), std::string::npos) << ran.err;
        EXPECT_EQ(scratch_.list(), before) << line;
    }
    [[nodiscard]] Image image(const std::string& name) const { return read_image(scratch_.path(name)).value(); }
    // Whether a channel of a file equals one of another file, to so many codes of 8 bits.
    [[nodiscard]] bool equal(const std::string& a, std::size_t channel, const std::string& b, std::size_t other,
                             float codes = 0.51f) const {
        const Image left = image(a), right = image(b);
        if (left.extent() != right.extent() || left.planes.size() <= channel || right.planes.size() <= other)
            return false;
        for (int j = 0; j < left.extent().height; ++j) {
            for (int i = 0; i < left.extent().width; ++i) {
                if (std::abs(left.planes[channel].at(i, j) - right.planes[other].at(i, j)) > codes / 255.0f)
                    return false;
            }
        }
        return true;
    }

    Scratch scratch_;
};

TEST_F(Extras, HeightsGoIntoAlpha) {
    run("bake-normals h.png -o nh.png --format rgba8 --alpha height --bumpiness 6");
    EXPECT_TRUE(equal("nh.png", 3, "h.png", 0));
    EXPECT_TRUE(equal("nh.png", 0, "n.png", 0));
    run("bake-normals h.png -o nh.dds --format rgba8 --alpha height --kind height --bumpiness 6");
    EXPECT_TRUE(equal("nh.dds", 3, "h.png", 0));
}

TEST_F(Extras, ALayoutRoundTrips) {
    run("pack-normals n.png -o pbr.png --layout labpbr --blue ao.png:g --alpha h.png");
    EXPECT_TRUE(equal("pbr.png", 2, "ao.png", 1));
    EXPECT_TRUE(equal("pbr.png", 3, "h.png", 0));
    run("unpack-normals pbr.png -o back.png --swizzle rg --y-in down --y up --blue-out ao2.png --alpha-out h2.png");
    EXPECT_TRUE(equal("ao2.png", 0, "ao.png", 1));
    EXPECT_TRUE(equal("h2.png", 0, "h.png", 0));
    EXPECT_EQ(shell(scratch_, "compare-normals n.png back.png --max 1.5").code, 0);
    // What is kept stays, through another container and a smaller level.
    run("mip-normals pbr.png -o pbr.dds --swizzle rg --blue keep --format rgba8 --kind occlusion,height");
    EXPECT_TRUE(equal("pbr.dds", 2, "ao.png", 1));
    EXPECT_TRUE(equal("pbr.dds", 3, "h.png", 0));
    run("scale-normals pbr.dds -o flat.dds --scale 0.5 --blue keep");
    EXPECT_TRUE(equal("flat.dds", 2, "ao.png", 1));
    run("blend-normals pbr.dds n.png -o blend.ktx2 --format rgba8");
    EXPECT_TRUE(equal("blend.ktx2", 3, "h.png", 0));
}

// Terrain3D: 8 bits of each component hold occlusion near 1 to seven codes.
TEST_F(Extras, OcclusionGoesIntoLengths) {
    constexpr float kCodes = 7.5f;
    run("pack-normals n.png -o t.png --layout terrain3d --alpha h.png --length ao.png:g");
    EXPECT_TRUE(equal("t.png", 3, "h.png", 0));
    const Ran judged = shell(scratch_, "check-normals t.png");
    EXPECT_NE(judged.out.find("N201"), std::string::npos) << judged.out;
    const Ran known = shell(scratch_, "check-normals t.png --length-in occlusion");
    EXPECT_EQ(known.out.find("N201"), std::string::npos) << known.out;
    scratch_.write("check.toml", "[[rule]]\nmatch = \"t.*\"\nlength-in = \"occlusion\"\n");
    const Ran matched = shell(scratch_, "check-normals t.png --config check.toml");
    EXPECT_EQ(matched.out, known.out);
    run("unpack-normals t.png -o back.png --length-in occlusion --length-out ao2.png");
    EXPECT_TRUE(equal("ao2.png", 0, "ao.png", 1, kCodes));
    EXPECT_EQ(shell(scratch_, "compare-normals n.png back.png --max 2").code, 0);
    // It stays through levels, scaling, blending and another depth.
    for (const std::string line :
         {"mip-normals t.png -o u.dds --format rgba8", "scale-normals t.png -o u.dds --scale 2 --format rgb16",
          "blend-normals t.png n.png -o u.dds --format half", "pack-normals t.png -o u.dds --format rgba16"}) {
        run(line + " --length-in occlusion");
        run("unpack-normals u.dds -o v.png --length-in occlusion --length-out ao3.png");
        EXPECT_TRUE(equal("ao3.png", 0, "ao2.png", 0, kCodes)) << line;
    }
    run("pack-normals t.png -o same.png --format rgba8 --length-in occlusion");
    for (const std::size_t channel : {0u, 1u, 2u, 3u}) EXPECT_TRUE(equal("same.png", channel, "t.png", channel, 0.0f));
    for (const std::string word : {"--length-in ignore", "--length-in occlusion --length none"}) {
        run("pack-normals t.png -o unit.png --format rgb8 " + word);
        EXPECT_EQ(shell(scratch_, "check-normals unit.png").out.find("N201"), std::string::npos) << word;
    }
    const Ran lost = shell(scratch_, "pack-normals t.png -o t.dds --format bc5 --alpha none --length-in occlusion");
    EXPECT_NE(lost.err.find("the lengths of vectors"), std::string::npos) << lost.err;
    EXPECT_NE(lost.err.find("hold data beside the normals"), std::string::npos) << lost.err;
}

TEST_F(Extras, GoThroughAConversion) {
    scratch_.write("sheet.obj", kSheetObj);
    run("pack-normals n.png -o nh.png --format rgba8 --alpha h.png --length ao.png:g");
    run("convert-normals nh.png -o o.png --mesh sheet.obj --to object --format rgba8 --length-in occlusion");
    EXPECT_TRUE(equal("o.png", 3, "h.png", 0));
    run("convert-normals o.png -o t.dds --mesh sheet.obj --from object --format rgba8 --length-in occlusion --kind "
        "height");
    EXPECT_TRUE(equal("t.dds", 3, "h.png", 0));
    run("unpack-normals t.dds -o t.png --length-in occlusion --length-out ao2.png");
    EXPECT_TRUE(equal("ao2.png", 0, "ao.png", 1, 2 * 7.5f));
    EXPECT_EQ(shell(scratch_, "compare-normals n.png t.png --max-mean 1").code, 0);
    run("convert-normals n.png -o pbr.png --mesh sheet.obj --decoder-in gltf --decoder unity-builtin --layout labpbr "
        "--blue ao.png:g --alpha h.png");
    EXPECT_TRUE(equal("pbr.png", 2, "ao.png", 1));
    EXPECT_TRUE(equal("pbr.png", 3, "h.png", 0));
    const Ran lost =
        shell(scratch_,
              "convert-normals nh.png -o t.dds --mesh sheet.obj --decoder-in gltf --decoder unity-builtin --no-sync");
    EXPECT_NE(lost.err.find("A (0"), std::string::npos) << lost.err;
    EXPECT_NE(lost.err.find("--format rgba8 keeps A"), std::string::npos) << lost.err;
    const Ran kept = shell(scratch_,
                           "convert-normals nh.png -o t.png --mesh sheet.obj --format rgba8 --decoder-in gltf "
                           "--decoder unity-builtin --no-sync");
    EXPECT_EQ(kept.err.find("left out"), std::string::npos) << kept.err;
    refuses("convert-normals n.png -o x.png --mesh sheet.obj --to object --blue h.png", 2, "object space needs z");
    refuses("convert-normals n.png -o x.dds --mesh sheet.obj --decoder-in gltf --decoder unity-builtin --alpha h.png",
            4, "dxt5nm has no alpha for data beside the normals; these formats have: rgba8");
}

TEST_F(Extras, ABlendOfAnotherExtentHasThem) {
    run("pack-normals n.png -o nh.png --format rgba8 --alpha h.png");
    run("blend-normals nh.png n.png -o half.png --format rgba8 --extent 256x256");
    ASSERT_EQ(shell(scratch_, "convert h.png -filter box -resize 50% half_h.png").code, 0);
    EXPECT_TRUE(equal("half.png", 3, "half_h.png", 0, 1.01f));
    // A detail of another extent changes none of it, and one with the name of the base is no base.
    run("blend-normals nh.png half.png -o whole.png --format rgba8");
    EXPECT_TRUE(equal("whole.png", 3, "nh.png", 3, 0.0f));
    const std::string twice = "blend-normals nh.png nh.png -o twice.png --format rgba8 --no-sync";
    EXPECT_NE(shell(scratch_, twice).err.find("data beside the normals, in A, are not blended"), std::string::npos);
    EXPECT_EQ(shell(scratch_, twice + " --drop").err, "");
}

TEST_F(Extras, SixteenBitsStaySixteen) {
    ASSERT_EQ(shell(scratch_, "convert h.png -blur 0x3 -depth 16 deep.png").code, 0);
    for (const std::string type : {"png", "tif"}) {
        run("bake-normals deep.png -o nh." + type + " --format rgba16 --alpha height --bumpiness 6");
        ASSERT_EQ(shell(scratch_, "convert nh." + type + " -alpha extract -depth 16 a.png").code, 0);
        const Ran same = shell(scratch_, "compare -metric AE a.png deep.png null:");
        EXPECT_EQ(same.err, "0") << type << ": ImageMagick sees the same alpha";
    }
    run("bake-normals deep.png -o nh.exr --format rgba32f --alpha height --bumpiness 6");
    EXPECT_TRUE(equal("nh.exr", 3, "deep.png", 0, 0.0f));
    // Without --format the encoding stays, alpha too.
    run("scale-normals nh.tif -o s.png --scale 2");
    EXPECT_TRUE(equal("s.png", 3, "deep.png", 0, 0.0f));
    EXPECT_EQ(read_texture(scratch_.path("s.png"))->format, Format::rgba16_unorm);
    run("scale-normals nh.exr -o s.exr --scale 2");
    EXPECT_TRUE(equal("s.exr", 3, "deep.png", 0, 0.0f));
    const Ran lost = shell(scratch_, "pack-normals nh.exr -o s.png --no-sync");
    EXPECT_NE(lost.err.find("--format rgba16 keeps A"), std::string::npos) << lost.err;
    run("pack-normals nh.exr -o s.png --format rgba16");
    EXPECT_TRUE(equal("s.png", 3, "deep.png", 0, 0.01f));
    EXPECT_NE(shell(scratch_, "pack-normals nh.png -o s.exr --no-sync").err.find("--format rgba16f keeps A"),
              std::string::npos);
    run("pack-normals nh.png -o s.exr --format rgba16f");
}

// Other programs take apart what we have put together, and we what they have: alpha is unassociated.
TEST_F(Extras, OtherProgramsSeeTheSameAlpha) {
    // A file with a picture of its alpha and one of its colours.
    const struct {
        const char* name;
        const char* script;
    } kPrograms[] = {
        {"ImageMagick",
         "convert $F -auto-orient -alpha extract -depth 8 a.png; convert $F -auto-orient -alpha off -depth 8 rgb.png"},
        {"OpenImageIO",
         "oiiotool --iconfig oiio:UnassociatedAlpha 1 $F --ch A -d uint8 -o a.png --pop "
         "--iconfig oiio:UnassociatedAlpha 1 $F --ch R,G,B -d uint8 -o rgb.png"},
        {"Pillow",
         "/usr/bin/python3 -c 'import sys; from PIL import Image; i = Image.open(sys.argv[1]); assert i.mode == "
         "\"RGBA\"; i.getchannel(3).save(\"a.png\"); Image.merge(\"RGB\", i.split()[:3]).save(\"rgb.png\")' $F"},
    };
    for (const std::string type : {"png", "tga", "tif", "dds"}) {
        run("pack-normals n.png -o both." + type + " --format rgba8 --alpha h.png");
        for (const auto& [name, script] : kPrograms) {
            const std::string what = name + (" and " + type);
            ASSERT_EQ(shell(scratch_, "F=both." + type + "; " + script).code, 0) << what;
            EXPECT_TRUE(equal("a.png", 0, "h.png", 0)) << what;
            EXPECT_TRUE(equal("rgb.png", 0, "n.png", 0)) << what << ": colours are not multiplied by alpha";
        }
    }
    ASSERT_EQ(shell(scratch_, "convert h.png -depth 8 h8.png").code, 0);
    const std::string theirs[] = {
        "convert n.png h8.png -alpha off -compose CopyOpacity -composite -depth 8 PNG32:theirs.png",
        "oiiotool n.png h8.png --ch A=Y --chappend --attrib oiio:UnassociatedAlpha 1 -d uint8 -o theirs.png",
        "/usr/bin/python3 -c 'from PIL import Image; i = Image.open(\"n.png\").convert(\"RGB\"); "
        "i.putalpha(Image.open(\"h8.png\").convert(\"L\")); i.save(\"theirs.png\")'"};
    for (const std::string& script : theirs) {
        ASSERT_EQ(shell(scratch_, script).code, 0) << script;
        run("pack-normals theirs.png -o ours.dds --format rgba8");
        EXPECT_TRUE(equal("ours.dds", 3, "h8.png", 0)) << script;
        EXPECT_TRUE(equal("ours.dds", 0, "n.png", 0)) << script;
    }
}

TEST_F(Extras, PatternsNameAFileForEachInput) {
    std::filesystem::create_directory(scratch_.path("in"));
    for (const std::string name : {"a", "b"}) {
        std::filesystem::copy_file(scratch_.path("n.png"), scratch_.path("in/" + name + "_n.png"));
        std::filesystem::copy_file(scratch_.path("h.png"), scratch_.path("in/" + name + "_h.png"));
    }
    run("pack-normals in/a_n.png in/b_n.png --out-dir out --name '{stem}.tga' --format rgba8 --alpha "
        "'{dir}/{stem:-_n}_h.png'");
    EXPECT_TRUE(equal("out/b_n.tga", 3, "h.png", 0));
}

TEST_F(Extras, WhatCannotBeIsOneError) {
    refuses("mip-normals n.png -o x.dds --format bc5 --blue ao.png:g --kind roughness", 2,
            "bc5 has no room for --blue; these formats have: rgb8");
    refuses("pack-normals n.png -o x.png --layout labpbr", 2, "give --blue FILE, or --blue 1 for none");
    refuses("pack-normals n.png -o x.png --layout skyrim --blue ao.png", 2, "--layout skyrim has z in blue");
    refuses("pack-normals n.png -o x.png --format rgba8 --alpha 2", 2, "--alpha");
    refuses("pack-normals n.png -o x.png --format rgba8 --alpha none.png", 3, "none.png");
    refuses("pack-normals n.png -o h.png --format rgba8 --alpha h.png", 2, "h.png");
    refuses("unpack-normals n.png -o x.png --alpha-out y.png", 4, "has no alpha beside the normals");
    refuses("unpack-normals n.png -o x.png --blue-out y.png", 4, "blue is read as z; --swizzle rg or labpbr reads it");
    refuses("unpack-normals n.png -o x.png --alpha-out n.png", 2, "n.png");
    refuses("pack-normals n.png -o x.png --length occlusion", 2, "--length occlusion needs --length-in occlusion");
    refuses("pack-normals n.png -o x.png --blue ao.png --length 0.5", 2, "--blue and --length exclude each other");
    refuses("pack-normals n.png -o x.dds --format bc5 --length 0.5", 2, "bc5 has no room for --length");
    refuses("pack-normals n.png -o x.png --keep-length --length 0.5", 2, "--length and --keep-length exclude");
    refuses("pack-normals n.png -o x.png --keep-length --length-in ignore", 2, "--length-in and --keep-length");
    refuses("unpack-normals n.png -o x.png --length-out y.png", 2, "--length-out needs --length-in occlusion");
    refuses("pack-normals n.png -o x.png --length-in height", 2, "occlusion");
}

}  // namespace
}  // namespace tex::cli
