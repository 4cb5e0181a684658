// SPDX-License-Identifier: Apache-2.0
// The page of --report, opened in Chromium: its light against that of preview-normals, its words, and what it does not
// do.

#include <cstdlib>
#include <filesystem>
#include <iostream>

#include <gtest/gtest.h>
#include <tex/file.h>

#include "browser/page.h"

namespace tex::browser {
namespace {

class ReportPage : public PageTest {
protected:
    // The GPU filters 8-bit texels with weights of 8 bits and returns BC3 rounded to 8 bits, where preview-normals
    // computes in double from exact palettes.
    void expect_picture_of_command(const std::string& what) {
        const Agreement found = compare_with_command(what);
        EXPECT_GE(found.share, 0.999) << what << ": " << found.command;
    }
};

TEST_F(ReportPage, LightsMapsAsPreviewNormalsDoes) {
    shell(
        "bake-normals bricks.png -o dxt5nm.dds --bumpiness 6; bake-normals bricks.png -o bc5.dds --format bc5 "
        "--bumpiness 6 --y down --dds-header dx10;"
        "bake-normals waves.png -o rgb.png --bumpiness 6; bake-normals waves.png -o snorm.ktx2 --format bc5-snorm "
        "--bumpiness 6;"
        "convert waves.png -crop 100x60+3+5 +repage odd.png; bake-normals odd.png -o odd.dds --bumpiness 6 --wrap "
        "clamp");
    for (const char* map : {"dxt5nm.dds", "bc5.dds", "rgb.png", "snorm.ktx2", "odd.dds"}) {
        shell(std::string("check-normals ") + map + " --report page.html");
        open("page.html");
        wait_for_light();
        EXPECT_NE(text(".stage .command").find("--light -0.8,1,1.2"), std::string::npos);
        point_at(0.71, 0.23);
        const std::string moved = text(".stage .command");
        EXPECT_NE(moved.find("--light 0.8"), std::string::npos) << moved;
        expect_picture_of_command(map);
    }
}

// Occlusion of another size than the map: it darkens the ambient light, whatever the light that moves.
TEST_F(ReportPage, MovesTheLightOverOcclusion) {
    shell(
        "bake-normals bricks.png -o map.png --bumpiness 12 --occlusion-out full.png;"
        "preview-normals map.png -o half.png --size 128 --occlusion full.png --ambient 1 --tint 1 --light-color 0;"
        "check-normals map.png --occlusion full.png --report page.html;"
        "check-normals map.png --occlusion half.png --report half.html; check-normals map.png --report without.html");
    const auto show = [&](const std::string& what) {
        js("(() => { const s = document.querySelector('.stage select[name=show]'); s.value = '" + what +
           "'; s.dispatchEvent(new Event('change')); })()");
        settle();
    };
    for (const char* page : {"page.html", "half.html"}) {
        open(page);
        wait_for_light();
        show("occluded");
        expect_picture_of_command(page);
        EXPECT_NE(text(".stage .command").find("--ambient 0.6 --occlusion "), std::string::npos);
        Extent extent;
        const std::vector<int> before = canvas(extent);
        point_at(0.71, 0.23);
        expect_picture_of_command(page);
        EXPECT_NE(canvas(extent), before);
        show("lit");
        expect_picture_of_command(page);
        EXPECT_EQ(text(".stage .command").find("--occlusion"), std::string::npos);
    }
    open("without.html");
    wait_for_light();
    EXPECT_EQ(text(".stage select[name=show]").find("occlusion"), std::string::npos);
}

TEST_F(ReportPage, ObeysTheKeyboard) {
    shell("bake-normals bricks.png -o map.png --bumpiness 6; check-normals map.png --report page.html");
    open("page.html");
    wait_for_light();
    js("document.querySelector('.stage canvas').focus({preventScroll: true})");
    Extent extent;
    const std::vector<int> before = canvas(extent);
    for (const char* key : {"ArrowRight", "ArrowDown", "PageUp", "+", "+", "y", "l"}) browser_->press_key(key);
    settle();
    const std::string command = text(".stage .command");
    for (const char* word : {"--light -0.3,0.4,1.3", "--light-kind point", "--bump-scale 1.2", "--y-in down"}) {
        EXPECT_NE(command.find(word), std::string::npos) << word << ": " << command;
    }
    EXPECT_NE(text(".stage [role=status]").find("green down"), std::string::npos);
    EXPECT_NE(canvas(extent), before);
    expect_picture_of_command("after seven keys");
    js("(() => { const s = document.querySelector('.stage select[name=tiles]'); s.value = '4'; s.dispatchEvent(new "
       "Event('change')); })()");
    settle();
    expect_picture_of_command("4 x 4 tiles");
    browser_->press_key("Home");
    settle();
    EXPECT_EQ(canvas(extent), before);
}

TEST_F(ReportPage, SplitsTwoMaps) {
    shell("bake-normals waves.png -o a.png --bumpiness 8; scale-normals a.png -o b.png --scale 0.2");
    EXPECT_EQ(shell("compare-normals a.png b.png --max 1 --report page.html"), 1);
    open("page.html");
    wait_for_light();
    Extent extent;
    const std::vector<int> half = canvas(extent);
    shell("preview-normals a.png -o a_lit.png; preview-normals b.png -o b_lit.png");
    const auto a = read_image(scratch_.path("a_lit.png")), b = read_image(scratch_.path("b_lit.png"));
    ASSERT_TRUE(a && b);
    const int scale = extent.width / a->extent().width;
    int wrong = 0;
    for (int j = 0; j < extent.height; j += 1) {
        for (const auto& [image, i] : {std::pair{&*a, extent.width / 4}, {&*b, extent.width * 3 / 4}}) {
            const int code = half[static_cast<std::size_t>(j) * static_cast<std::size_t>(extent.width) +
                                  static_cast<std::size_t>(i)];
            if (scale == 1 && std::abs(code - static_cast<int>(image->planes[0].at(i, j) * 255.0f + 0.5f)) > kCodes)
                ++wrong;
        }
    }
    EXPECT_LE(wrong, extent.height / 100);
    point_at(0.25, 0.5, true);
    EXPECT_NE(canvas(extent), half) << "dragging moves the split";
    EXPECT_EQ(js("document.querySelector('.stage .split').style.left").get<std::string>().substr(0, 2), "25");
    EXPECT_NE(text("table.levels").find("99.9"), std::string::npos);
}

TEST_F(ReportPage, TakesNamesAsText) {
    const std::string name = "<script>window.broken=1<!-- \"><img src=x onerror=window.broken=1>';${1} \xff.png";
    shell("bake-normals waves.png -o map.png --bumpiness 6");
    std::filesystem::copy_file(scratch_.path("map.png"), scratch_.path("folder.png"));
    // A name cannot hold a slash, so "</script>" comes by way of a folder.
    shell("mkdir '<' && cp map.png '</script><script>window.broken=1.png'");
    std::filesystem::copy_file(scratch_.path("map.png"), scratch_.path(name));
    const cli::Ran ran = cli::run(scratch_, "check-normals",
                                  {name, "</script><script>window.broken=1.png", "map.png", "--report", "page.html"});
    ASSERT_LE(ran.code, 1) << ran.err;
    open("page.html");
    wait_for_light();
    EXPECT_EQ(js("typeof window.broken").get<std::string>(), "undefined");
    EXPECT_EQ(js("document.querySelectorAll('img[src=x]').length").get<int>(), 0);
    EXPECT_EQ(js("document.querySelectorAll('section.file').length").get<int>(), 3);
    EXPECT_NE(text("#files tbody").find("</script><script>window.broken=1.png"), std::string::npos);
    EXPECT_NE(text("#files tbody").find("<script>window.broken=1<!-- \"><img src=x onerror=window.broken=1>';${1}"),
              std::string::npos);
}

TEST_F(ReportPage, IsReadableWithoutJavaScript) {
    shell("bake-normals bricks.png -o map.dds --bumpiness 6; check-normals map.dds --report page.html");
    browser_->call("Emulation.setScriptExecutionDisabled", {{"value", true}});
    open("page.html");
    EXPECT_EQ(js("document.querySelectorAll('canvas, button, input').length").get<int>(), 0);
    EXPECT_GE(js("document.images.length").get<int>(), 5);
    EXPECT_TRUE(
        browser_->wait_for("[...document.images].every(i => { i.loading = 'eager'; return i.complete && i.naturalWidth "
                           "=== Number(i.getAttribute('width')); })"));
    EXPECT_TRUE(js("[...document.querySelectorAll('figure img')].every(i => i.alt.startsWith('map.dds'))").get<bool>());
    EXPECT_NE(text(".facts").find("dxt5nm"), std::string::npos);
}

TEST_F(ReportPage, FiltersAndSortsManyFiles) {
    shell(
        "for n in 1 2 3 4 5 6 7 8 9; do bake-normals ramp.png -o r$n.png --bumpiness $n; done; bake-normals waves.png "
        "-o w.dds --bumpiness 6; echo no > bad.dds");
    EXPECT_GE(cli::shell(scratch_, "check-normals r[0-9].png w.dds bad.dds --report page.html").code, 1);
    open("page.html");
    wait_for_light();
    const std::string shown = "[...document.querySelectorAll('#files tbody tr')].filter(r => !r.hidden).length";
    EXPECT_EQ(js(shown).get<int>(), 11);
    js("document.querySelector('[data-word=error]').click()");
    EXPECT_GE(js(shown).get<int>(), 1);
    EXPECT_LT(js(shown).get<int>(), 11);
    js("document.querySelector('[data-word=\"\"]').click()");
    js("(() => { const i = document.querySelector('input[type=search]'); i.value = 'bc3'; i.dispatchEvent(new "
       "Event('input')); })()");
    EXPECT_EQ(js(shown).get<int>(), 1);
    js("(() => { const i = document.querySelector('input[type=search]'); i.value = ''; i.dispatchEvent(new "
       "Event('input')); })()");
    js("[0, 1].forEach(() => document.querySelector('#files thead button').click())");
    EXPECT_EQ(js("document.querySelector('#files tbody th').textContent").get<std::string>(), "w.dds");
}

// Stages start as they come into view. Nothing moves then, however long the page is.
TEST_F(ReportPage, LinksReachFilesAnywhereOnALongPage) {
    shell(
        "convert waves.png -crop 100x60+3+5 +repage odd.png; convert waves.png -crop 48x128+0+0 +repage high.png;"
        "for n in waves odd high; do bake-normals $n.png -o $n.dds --format rgba8 --bumpiness 6; done; mkdir many;"
        "for k in $(seq 100 299); do case $((k % 3)) in 0) n=waves;; 1) n=odd;; 2) n=high;; esac; "
        "cp $n.dds many/$k.dds; done; mv many/150.dds many/150-$(printf 'long%.0s' $(seq 40)).dds;"
        "check-normals many/*.dds --report page.html");
    for (const int width : {1280, 390}) {
        browser_->set_viewport(width, 1000);
        open("page.html");
        const double height = js("document.documentElement.scrollHeight").get<double>();
        for (const int file : {150, 3, 198, 77}) {
            const std::string section = "document.getElementById('file-" + std::to_string(file) + "')";
            js("document.querySelector('a[href=\"#file-" + std::to_string(file) + "\"]').click()");
            js("new Promise(done => { let last = -1, same = 0; const look = () => { same = scrollY === last ? same + 1 "
               ": 0; last = scrollY; same > 20 ? done() : requestAnimationFrame(look); }; look(); })");
            EXPECT_TRUE(browser_->wait_for("!!" + section + ".querySelector('canvas') && !" + section +
                                           ".querySelector('.view').hidden"));
            const double top = js(section + ".getBoundingClientRect().top").get<double>();
            EXPECT_NEAR(top, 12.0, 2.0) << "file " << file << " in a window " << width << " wide";
        }
        EXPECT_EQ(js("document.documentElement.scrollHeight").get<double>(), height) << width;
    }
}

TEST_F(ReportPage, OpensWithGreenAsMeasured) {
    shell(
        "bake-normals waves.png -o up.dds --bumpiness 6; bake-normals waves.png -o down.png --bumpiness 6 --y down;"
        "bake-normals waves.png -o down.dds --bumpiness 6 --y down");
    const auto lit = [&](const std::string& map) {
        shell("check-normals " + map + " --report page.html");
        open("page.html");
        wait_for_light();
        Extent extent;
        return canvas(extent);
    };
    const std::vector<int> up = lit("up.dds");
    EXPECT_EQ(js("document.querySelector('.stage select[name=yA]').value").get<std::string>(), "up");
    for (const char* map : {"down.dds", "down.png"}) {
        const std::vector<int> down = lit(map);
        EXPECT_EQ(js("document.querySelector('.stage select[name=yA]').value").get<std::string>(), "down") << map;
        EXPECT_NE(text(".stage .command").find("--y-in down"), std::string::npos) << map;
        ASSERT_EQ(down.size(), up.size());
        double sum = 0.0;
        for (std::size_t k = 0; k < up.size(); ++k) sum += std::abs(up[k] - down[k]);
        EXPECT_LT(sum / static_cast<double>(up.size()), 1.5) << map << " is lit as the same map with green up";
    }
}

TEST_F(ReportPage, NamesGreenWhereTheFileStatesTheOppositeOfItsTexels) {
    shell(
        "bake-normals waves.png -o up.png --bumpiness 6;"
        "pack-normals up.png -o down.ktx2 --format bc5 --y-in down --y down;"
        "check-normals down.ktx2 --report page.html");
    open("page.html");
    wait_for_light();
    EXPECT_EQ(js("document.querySelector('.stage select[name=yA]').value").get<std::string>(), "up");
    expect_picture_of_command("green up, stated as down");
}

// With TEX_SCREENSHOTS set to a folder, pictures of the page are left there.
TEST_F(ReportPage, HasTwoThemesAndFitsNarrowWindows) {
    shell(
        "bake-normals bricks.png -o bricks_n.dds --bumpiness 12 --y down; bake-normals waves.png -o waves_n.png "
        "--bumpiness 8;"
        "check-normals bricks_n.dds waves_n.png --require y=up --report page.html");
    double brightness[2] = {};
    for (const int width : {1160, 390}) {
        for (const char* theme : {"light", "dark"}) {
            const bool dark = std::string(theme) == "dark";
            browser_->set_viewport(width, width > 1000 ? 980 : 844);
            browser_->call("Emulation.setEmulatedMedia",
                           {{"features", {{{"name", "prefers-color-scheme"}, {"value", theme}}}}});
            open("page.html");
            wait_for_light();
            EXPECT_LE(js("document.documentElement.scrollWidth").get<int>(), width) << "nothing hangs over";
            if (width > 1000) js("window.scrollTo({top: 0, behavior: 'instant'})");
            settle();
            const std::string picture = std::string(theme) + "-" + std::to_string(width) + ".png";
            scratch_.write(picture, browser_->screenshot());
            const auto image = read_image(scratch_.path(picture));
            ASSERT_TRUE(image);
            EXPECT_EQ(image->extent().width, width);
            brightness[dark ? 1 : 0] = static_cast<double>(image->planes[0].at(3, 3));
            if (const char* folder = std::getenv("TEX_SCREENSHOTS"))
                std::filesystem::copy_file(scratch_.path(picture), std::filesystem::path(folder) / picture,
                                           std::filesystem::copy_options::overwrite_existing);
        }
        EXPECT_GT(brightness[0], 0.8);
        EXPECT_LT(brightness[1], 0.2);
    }
}

TEST_F(ReportPage, HoldsManyRealMaps) {
    if (!std::filesystem::exists(TEX_SOURCE_DIR "/../shared/data")) GTEST_SKIP() << "../shared/data is not here";
    EXPECT_LE(cli::shell(scratch_, "check-normals " TEX_SOURCE_DIR "/../shared/data/normal/* " TEX_SOURCE_DIR
                                   "/../shared/data/dds/*.dds --report page.html")
                  .code,
              4);
    const auto size = std::filesystem::file_size(scratch_.path("page.html"));
    EXPECT_LT(size, 20'000'000u);
    const double milliseconds = open("page.html");
    wait_for_light();
    std::cout << "a report of " << size << " bytes opens in " << milliseconds << " ms\n";
    EXPECT_GE(js("document.querySelectorAll('section.file').length").get<int>(), 27);
}

}  // namespace
}  // namespace tex::browser
