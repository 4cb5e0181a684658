// SPDX-License-Identifier: Apache-2.0
// The files of --report of check-normals and compare-normals. tests/browser opens them.

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cli/meshes.h"
#include "cli/program.h"

namespace tex::cli {

class Report : public testing::Test {
protected:
    Report() {
        scratch_.add_sample("waves.png", "waves.png");
        EXPECT_EQ(shell(scratch_,
                        "bake-normals waves.png -o up.dds --bumpiness 6 --no-sync && "
                        "bake-normals waves.png -o down.png --bumpiness 6 --y down --no-sync")
                      .code,
                  0);
    }
    Ran check(const std::vector<std::string>& arguments) { return run(scratch_, "check-normals", arguments); }
    Ran compare(const std::vector<std::string>& arguments) { return run(scratch_, "compare-normals", arguments); }
    [[nodiscard]] bool page_has(const std::string& text) const {
        return scratch_.read("page.html").find(text) != std::string::npos;
    }
    Scratch scratch_;
};

TEST_F(Report, HoldsFilesFindingsFiguresAndFixes) {
    scratch_.write("bad.dds", "DDS nonsense");
    const Ran ran = check({"up.dds", "down.png", "bad.dds", "--require", "y=up", "--report", "page.html"});
    EXPECT_EQ(ran.code, 4) << ran.err;
    for (const char* text : {"<!doctype html>", "N401 wrong-y", "Fix: <code>", "up.dds", "bad.dds", "N101", "dxt5nm",
                             "alt=\"down.png: lit from the upper left\"", "id=\"map-1\"", "</html>"}) {
        EXPECT_TRUE(page_has(text)) << text;
    }
    EXPECT_FALSE(page_has(scratch_.path())) << "no path beyond what was given";
    EXPECT_FALSE(page_has("://")) << "nothing is loaded from elsewhere";
}

TEST_F(Report, ShowsWhichTexelsSpoke) {
    const std::string broken = std::string(TEX_SOURCE_DIR) + "/samples/broken/";
    check({broken + "N215-background.png", "up.dds", "--report", "page.html"});
    for (const char* text : {"<figure class=\"marks\">", "<figcaption>Orange: ", " of the texels spoke for N215",
                             "those that spoke lie in columns ", "style=\"--map: url(data:image/png;base64,"}) {
        EXPECT_TRUE(page_has(text)) << text;
    }
    check({broken + "N302-srgb-encoded.png", "--report", "page.html"});
    EXPECT_TRUE(page_has("No texel spoke alone: the rule judges the map as a whole."));
    EXPECT_FALSE(page_has("<figure class=\"marks\">"));
    check({"up.dds", "--report", "page.html"});
    EXPECT_FALSE(page_has("Orange: ") || page_has("No texel spoke")) << "a page without findings";
}

TEST_F(Report, HasTheSameBytesForEveryNumberOfThreads) {
    check({"up.dds", "down.png", "--report", "one.html", "--threads", "1"});
    check({"down.png", "up.dds", "--report", "many.html", "--threads", "4"});
    EXPECT_EQ(scratch_.read("one.html"), scratch_.read("many.html"));
    EXPECT_FALSE(scratch_.read("one.html").empty());
}

TEST_F(Report, ShowsTheMeshAndItsSeamsWithGreenAsTheyWereChecked) {
    const std::string broken = std::string(TEX_SOURCE_DIR) + "/samples/broken/";
    const std::string map = broken + "N711-other-tangent-space.png", mesh = broken + "meshes/N711.glb";
    check({map, "--mesh", mesh, "--report", "page.html"});
    for (const char* text :
         {"<figcaption>on the mesh</figcaption>", "<figcaption>seams</figcaption>", "<figcaption>UVs</figcaption>"})
        EXPECT_TRUE(page_has(text)) << text;
    check({map, "--report", "page.html"});
    EXPECT_FALSE(page_has("seams"));
    // The picture is that of preview-normals.
    for (const char* y : {"up", "down"}) {
        const std::string require = std::string("y=") + y;
        check({map, "--mesh", mesh, "--require", require, "--report", "page.html"});
        const Ran drawn =
            run(scratch_, "preview-normals",
                {map, "-o", "seams.png", "--mesh", mesh, "--y-in", y, "--show", "seams", "--size", "384", "--no-sync"});
        EXPECT_EQ(drawn.code, 0) << drawn.err;
        const std::string encoded = shell(scratch_, "base64 -w0 seams.png").out;
        EXPECT_TRUE(page_has(encoded)) << y;
    }
}

TEST_F(Report, HoldsTheMeshOnceAndTheCommandThatDrawsIt) {
    const std::string mesh = "--mesh=</script><script>'a.obj";
    scratch_.write("sheet.obj", kSheetObj);
    EXPECT_EQ(shell(scratch_, "mkdir '<'; mv sheet.obj \"</script><script>'a.obj\"").code, 0);
    const std::vector<std::string> files = {"up.dds", "down.png", mesh, "--decoder", "three", "--report"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.begin(), files.begin(), files.end());
        const Ran ran = check(more);
        EXPECT_LE(ran.code, 1) << ran.err;
    };
    with({"page.html", "--threads", "1"});
    for (const char* text : {"id=\"mesh-0\"", "data-mesh=\"0\" data-y=\"up\" data-file=\"up.dds\"",
                             "data-mesh=\"0\" data-y=\"down\" data-file=\"down.png\"", "\"decoder\":\"three\"",
                             "--mesh '\\u003c/script>\\u003cscript>'", "<figcaption>on the mesh</figcaption>"})
        EXPECT_TRUE(page_has(text)) << text;
    EXPECT_FALSE(page_has("id=\"mesh-1\""));
    EXPECT_FALSE(page_has("<script>'a.obj"));
    EXPECT_FALSE(page_has("seams</figcaption>")) << "this mesh has none";
    with({"many.html", "--threads", "4"});
    EXPECT_EQ(scratch_.read("page.html"), scratch_.read("many.html"));
    check({"up.dds", "--report", "page.html"});
    for (const char* text : {"id=\"meshes\"", "id=\"mesh-0\"", "data-mesh"}) EXPECT_FALSE(page_has(text)) << text;
}

TEST_F(Report, HoldsTheLevelsThatWereCompared) {
    EXPECT_EQ(compare({"up.dds", "down.png", "--y-b", "down", "--level", "0", "--report", "page.html"}).code, 0);
    EXPECT_TRUE(page_has("data-other=\"1\""));
    EXPECT_TRUE(page_has("A on the left, B on the right"));
    EXPECT_EQ(compare({"up.dds", "down.png", "--max", "1", "--report", "page.html"}).code, 1);
    EXPECT_TRUE(page_has("class=\"over\""));
}

TEST_F(Report, RefusesWhatItCannotWriteOrWouldDestroy) {
    const std::string before = scratch_.read("up.dds");
    EXPECT_EQ(check({"up.dds", "--report", "up.dds"}).code, 2);
    EXPECT_EQ(check({"up.dds", "--report", "./up.dds"}).code, 2);
    std::filesystem::create_symlink("up.dds", scratch_.path("link.html"));
    EXPECT_EQ(check({"up.dds", "--report", "link.html"}).code, 2);
    EXPECT_EQ(check({"up.dds", "--report", "x.html", "--sarif", "./x.html"}).code, 2);
    EXPECT_EQ(check({"up.dds", "--report", "x.html", "--junit", "x.html"}).code, 2);
    EXPECT_EQ(check({"up.dds", "--report", "-"}).code, 2);
    EXPECT_EQ(check({"up.dds", "--report", ""}).code, 2);
    EXPECT_EQ(check({"up.dds", "--report", "."}).code, 2);
    EXPECT_EQ(check({"-", "--report", "x.html"}).code, 2);
    EXPECT_EQ(check({"--list", "--report", "x.html"}).code, 2);
    EXPECT_EQ(check({"--explain", "N401", "--report", "x.html"}).code, 2);
    EXPECT_EQ(compare({"up.dds", "down.png", "--report", "down.png"}).code, 2);
    EXPECT_EQ(compare({"up.dds", "down.png", "--report", "x.png", "--heatmap", "x.png"}).code, 2);
    EXPECT_FALSE(scratch_.has("x.html"));
    EXPECT_EQ(scratch_.read("up.dds"), before);
    const Ran ran = check({"up.dds", "--report", "gone/x.html"});
    EXPECT_EQ(ran.code, 3);
    EXPECT_NE(ran.err.find("gone/x.html"), std::string::npos) << ran.err;
    EXPECT_EQ(compare({"up.dds", "up.dds", "--report", "gone/x.html"}).code, 3);
}

}  // namespace tex::cli
