// SPDX-License-Identifier: Apache-2.0
// The mesh in the page of --report, opened in Chromium: its light and camera against those of preview-normals.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "browser/page.h"

namespace tex::browser {
namespace {

constexpr int kColumns = 6, kRows = 3;
constexpr int kVertices = (kColumns + 1) * (kRows + 1);

// A wavy sphere of few triangles, on which decoders differ. The UVs of its left half mirror those of the right half.
// `first` is the number of its first vertex; its UVs are moved to the right by `shift`.
std::string sphere_obj(int first = 1, double shift = 0.0) {
    std::string text, faces;
    for (int j = 0; j <= kRows; ++j) {
        for (int i = 0; i <= kColumns; ++i) {
            const double around = 2.0 * std::numbers::pi * i / kColumns,
                         up = std::numbers::pi * (0.5 - 1.0 * j / kRows);
            const double radius = 1.0 + 0.1 * std::cos(3.0 * around) * std::cos(up);
            const double x = std::cos(up) * std::sin(around), y = std::sin(up), z = std::cos(up) * std::cos(around);
            text += fmt::format("v {:.6f} {:.6f} {:.6f}\n", radius * x, 0.8 * radius * y, radius * z);
            text += fmt::format("vn {:.6f} {:.6f} {:.6f}\n", x, 1.2 * y, z);
            const double u = 2.0 * std::min(i, kColumns - i) / kColumns;
            const double v = 1.0 - 1.0 * j / kRows, askew = 0.1 * std::sin(3.0 * i + 5.0 * j);
            text += fmt::format("vt {:.6f} {:.6f}\n", shift + 0.05 + 0.9 * u, 0.05 + 0.9 * v + askew);
            if (i == kColumns || j == kRows) continue;
            const int a = j * (kColumns + 1) + i + first, b = a + kColumns + 1;
            const auto triangle = [&](int p, int q, int r) {
                faces += fmt::format("f {0}/{0}/{0} {1}/{1}/{1} {2}/{2}/{2}\n", p, q, r);
            };
            triangle(a, b, b + 1);
            triangle(a, b + 1, a + 1);
        }
    }
    return text + faces;
}

class ReportMesh : public PageTest {
protected:
    ReportMesh() { stage_ = ".stage.mesh"; }

    void make_sphere() {
        scratch_.write("sphere.obj", sphere_obj());
        shell("bake-normals waves.png -o map.png --bumpiness 6 --no-sync");
    }
    void open_report(const std::string& arguments) {
        shell("check-normals " + arguments + " --report page.html");
        open("page.html");
        wait_for_light();
    }
    // All pixels count, outlines too. There the GPU has 4 samples for a pixel and preview-normals 16, so some differ.
    void expect_picture_of_command(const std::string& what) {
        const Agreement found = compare_with_command(what);
        EXPECT_GE(found.share, 0.99) << what << ": " << found.command;
    }
    // Turns and lights the mesh in two more ways.
    void expect_pictures(const std::string& what) {
        point_at(0.3, 0.6);
        point_at(0.75, 0.35, true);
        expect_picture_of_command(what + ", dragged");
        point_at(0.2, 0.8);
        set_control("yaw", "-130");
        set_control("pitch", "-35");
        expect_picture_of_command(what + ", from below");
    }
};

TEST_F(ReportMesh, LightsAMirroredMeshAsPreviewNormalsDoes) {
    make_sphere();
    shell(
        "bake-normals waves.png -o bc5.dds --format bc5 --dds-header dx10 --y down --bumpiness 6;"
        "bake-normals waves.png -o dxt5nm.dds --bumpiness 6; pack-normals map.png -o one.dds --format bc5 --mips none;"
        "convert map.png -strip plain.png; bake-normals waves.png -o steep.png --bumpiness 30");
    std::vector<std::vector<int>> pictures;
    for (const char* decoder : {"gltf", "unity-builtin", "three"}) {
        open_report(std::string("steep.png --mesh sphere.obj --require y=up --decoder ") + decoder);
        EXPECT_NE(command().find(std::string("--decoder ") + decoder), std::string::npos) << command();
        Extent extent;
        pictures.push_back(canvas(extent));
        expect_pictures(decoder);
    }
    for (const auto& [a, b] : {std::pair{0, 1}, {1, 2}, {2, 0}}) {
        const std::vector<int>&p = pictures[static_cast<std::size_t>(a)], &q = pictures[static_cast<std::size_t>(b)];
        int differ = 0;
        for (std::size_t k = 0; k < p.size(); ++k) differ += std::abs(p[k] - q[k]) > kCodes ? 1 : 0;
        const double share = static_cast<double>(differ) / static_cast<double>(p.size());
        std::cout << "decoders " << a << " and " << b << " differ on " << share << "\n";
        EXPECT_GT(share, 0.05) << "a picture with the wrong decoder would be found";
    }
    for (const char* map : {"bc5.dds", "dxt5nm.dds", "one.dds"}) {
        open_report(std::string(map) + " --mesh sphere.obj --decoder unity-urp");
        expect_picture_of_command(map);
    }
    EXPECT_NE(text(".stage.mesh .remark").find("with 8 bits per channel"), std::string::npos) << "a map of one level";
    open_report("plain.png --mesh sphere.obj --decoder unreal");
    EXPECT_NE(command().find("--y-in down"), std::string::npos) << "as Unreal reads maps: " << command();
    expect_picture_of_command("unreal");
}

TEST_F(ReportMesh, BeginsWithTheStillPicture) {
    make_sphere();
    open_report("map.png --mesh sphere.obj");
    const std::string line = command();
    for (const char* part : {"--mesh sphere.obj", "--decoder gltf", "--camera 30,20 ", "--light -0.8,1,1.2 "})
        EXPECT_NE(line.find(part), std::string::npos) << part << ": " << line;
    EXPECT_TRUE(js(in_stage("img") + ".hidden").get<bool>());
    EXPECT_EQ(js("document.querySelectorAll('.stage').length").get<int>(), 2);
    expect_picture_of_command("as it begins");
}

TEST_F(ReportMesh, FitsNarrowWindowsAndMovesNothingWhenItStarts) {
    make_sphere();
    shell("for k in 1 2 3 4; do cp map.png map$k.png; done");
    for (const int width : {1160, 390}) {
        browser_->set_viewport(width, 900);
        shell("check-normals map?.png --mesh sphere.obj --report page.html");
        open("page.html");
        const double height = js("document.documentElement.scrollHeight").get<double>();
        for (const char* file : {"4", "2"}) {
            stage_ = std::string("#file-") + file + " .stage.mesh";
            wait_for_light();
        }
        EXPECT_EQ(js("document.documentElement.scrollHeight").get<double>(), height) << width;
        EXPECT_LE(js("document.documentElement.scrollWidth").get<int>(), width) << "nothing hangs over";
    }
    EXPECT_EQ(js("document.querySelectorAll('[id=mesh-0]').length").get<int>(), 1) << "four maps share it";
}

TEST_F(ReportMesh, ObeysPointerKeysAndControls) {
    make_sphere();
    open_report("map.png --mesh sphere.obj --require y=up");
    Extent extent;
    const std::vector<int> before = canvas(extent);
    js(in_stage("canvas") + ".focus({preventScroll: true})");
    for (const char* key : {"d", "d", "w", "A", "+", "y", "l", "ArrowLeft", "PageUp"}) browser_->press_key(key);
    settle();
    const std::string line = command();
    for (const char* part : {"--camera 35,25", "--light-kind point", "--bump-scale 1.1", "--y-in down"})
        EXPECT_NE(line.find(part), std::string::npos) << part << ": " << line;
    EXPECT_NE(text(".stage.mesh [role=status]").find("camera 35, 25"), std::string::npos);
    expect_picture_of_command("after keys");
    set_control("decoder", "godot");
    EXPECT_NE(command().find("--decoder godot"), std::string::npos);
    expect_picture_of_command("another decoder, a point light");
    browser_->press_key("Home");
    settle();
    EXPECT_EQ(canvas(extent), before);
    EXPECT_EQ(text(".stage.mesh .command").find("--light-kind"), std::string::npos);
    // The plane beside it keeps its own light.
    EXPECT_NE(text(".stage .command").find("--light -0.8,1,1.2"), std::string::npos);
}

TEST_F(ReportMesh, DrawsTheTilesAndPartsThatWereChecked) {
    make_sphere();
    shell("cp map.png 'a b.1001.png'; cp map.png 'a b.1002.png'");
    scratch_.write("tiles.obj", "o one\nusemtl first\n" + sphere_obj() + "o two\nusemtl first\n" +
                                    sphere_obj(1 + kVertices, 1.0) + "o three\nusemtl other\n" +
                                    sphere_obj(1 + 2 * kVertices));
    open_report("'a b.<UDIM>.png' --mesh tiles.obj --material first --tangents mikktspace");
    const std::string line = command();
    for (const char* part :
         {"'a b.<UDIM>.png' --name 'lit-{stem}.png' --mesh tiles.obj --material first", "--tangents mikktspace"})
        EXPECT_NE(line.find(part), std::string::npos) << part << ": " << line;
    shell(line + " --no-sync && mv 'lit-a b.1001.png' lit.png");
    js(in_stage(".command") + ".textContent = 'true'");  // the picture is there
    expect_picture_of_command("tile 1001");
    EXPECT_EQ(js("document.querySelectorAll('[id^=mesh-]').length").get<int>(), 3) << "two tiles, and the keys";
}

TEST_F(ReportMesh, StaysAStillPictureWithoutWebGl) {
    make_sphere();
    open_report("map.png --mesh sphere.obj");
    browser_->call(
        "Page.addScriptToEvaluateOnNewDocument",
        {{"source",
          "{ const own = HTMLCanvasElement.prototype.getContext; HTMLCanvasElement.prototype.getContext = "
          "function(kind, ...rest) { return kind === 'webgl2' ? null : own.call(this, kind, ...rest); }; }"}});
    open("page.html");
    EXPECT_EQ(js("document.querySelectorAll('canvas, .panel').length").get<int>(), 0);
    EXPECT_FALSE(js(in_stage("img") + ".hidden").get<bool>());
    EXPECT_NE(text("footer").find("cannot light the maps"), std::string::npos);
}

TEST_F(ReportMesh, ShowsTheStillPictureAgainWhenTheGpuIsLost) {
    make_sphere();
    browser_->call("Page.addScriptToEvaluateOnNewDocument",
                   {{"source",
                     "{ const own = HTMLCanvasElement.prototype.getContext; HTMLCanvasElement.prototype.getContext = "
                     "function(kind, ...rest) { const made = own.call(this, kind, ...rest); if (kind === 'webgl2') "
                     "window.gpu = made; return made; }; }"}});
    open_report("map.png --mesh sphere.obj");
    js("window.gpu.getExtension('WEBGL_lose_context').loseContext()");
    EXPECT_TRUE(
        browser_->wait_for("[...document.querySelectorAll('.stage')].every(s => !s.querySelector('img').hidden "
                           "&& s.querySelector('.view').hidden)"));
    EXPECT_NE(text(".stage.mesh .panel > .remark").find("reload the page"), std::string::npos);
}

TEST_F(ReportMesh, IsReadableWithoutJavaScript) {
    make_sphere();
    shell("check-normals map.png --mesh sphere.obj --report page.html");
    browser_->call("Emulation.setScriptExecutionDisabled", {{"value", true}});
    open("page.html");
    EXPECT_EQ(js("document.querySelectorAll('.stage img').length").get<int>(), 2);
    EXPECT_EQ(text(".stage.mesh figcaption"), "on the mesh");
    EXPECT_EQ(js("document.querySelectorAll('canvas, button, input').length").get<int>(), 0);
}

// With TEX_SCREENSHOTS set to a folder, pictures of the pages are left there.
TEST_F(ReportMesh, DrawsModelsOfOthers) {
    const std::string data = TEX_SOURCE_DIR "/../shared/data/mesh/";
    if (!std::filesystem::exists(data)) GTEST_SKIP() << "../shared/data is not here";
    struct Model {
        const char* name;
        std::string arguments;
    };
    const std::string helmet = data + "FlightHelmet/FlightHelmet";
    shell("convert-normals " + data + "Suzanne/02_suzanne_Normal.png -o suzanne.dds --format bc5 --mesh " + data +
          "Suzanne/02_suzanne.gltf --decoder-in gltf --decoder unity-builtin --no-sync");
    // The picture is inside of the mesh's file. It has no tangents, and some of MikkTSpace's have w = -1.
    shell(fmt::format("tail -c +1584501 {0}NormalTangentTest.glb | head -c 336676 > spheres.png", data));
    for (const Model& model :
         {Model{"suzanne", data + "Suzanne/02_suzanne_Normal.png --mesh " + data + "Suzanne/02_suzanne.gltf"},
          {"suzanne-unity",
           "suzanne.dds --mesh " + data + "Suzanne/02_suzanne.gltf --tangents mikktspace --decoder unity-builtin"},
          {"spheres", "spheres.png --mesh " + data + "NormalTangentTest.glb --decoder unity-hdrp"},
          {"leather", helmet + "_Materials_LeatherPartsMat_Normal.png --mesh " + helmet +
                          ".gltf --material LeatherPartsMat --decoder three"}}) {
        for (const char* theme : {"light", "dark"}) {
            browser_->call("Emulation.setEmulatedMedia",
                           {{"features", {{{"name", "prefers-color-scheme"}, {"value", theme}}}}});
            open_report(model.arguments);
            const char* folder = std::getenv("TEX_SCREENSHOTS");
            if (folder == nullptr) break;
            point_at(0.3, 0.3);
            std::filesystem::create_directories(folder);
            scratch_.write("shot.png", browser_->screenshot());
            std::filesystem::copy_file(scratch_.path("shot.png"),
                                       std::filesystem::path(folder) / fmt::format("{}-{}.png", model.name, theme),
                                       std::filesystem::copy_options::overwrite_existing);
        }
        expect_pictures(model.name);
    }
}

}  // namespace
}  // namespace tex::browser
