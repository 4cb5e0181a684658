// SPDX-License-Identifier: Apache-2.0
// The page of transfer-normals --report, opened in Chromium: both meshes turn together, and missed texels are red.

#include <cstdlib>
#include <filesystem>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "browser/page.h"

namespace tex::browser {
namespace {

class TransferPage : public PageTest {
protected:
    TransferPage() { stage_ = ".stage.mesh"; }

    void open_report(const std::string& arguments) {
        shell("cp -n " TEX_SOURCE_DIR "/samples/crate_*.glb .; transfer-normals " + arguments +
              " -o n.png --report page.html --no-sync --quiet");
        open("page.html");
        wait_for_light();
        EXPECT_TRUE(browser_->wait_for("!document.querySelector('.stage.beside .view').hidden"));
        settle();
    }
    std::vector<int> canvas_of(const std::string& stage) {
        const std::string own = std::exchange(stage_, stage);
        Extent extent;
        std::vector<int> codes = canvas(extent);
        stage_ = own;
        return codes;
    }
    // The part of pixels that differ by more than kCodes.
    static double differing(const std::vector<int>& a, const std::vector<int>& b) {
        EXPECT_EQ(a.size(), b.size());
        int count = 0;
        for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) count += std::abs(a[k] - b[k]) > kCodes ? 1 : 0;
        return static_cast<double>(count) / static_cast<double>(a.size());
    }
    // With TEX_SCREENSHOTS set to a folder, pictures of the pages are left there.
    void leave_picture(const std::string& name) {
        const char* const folder = std::getenv("TEX_SCREENSHOTS");
        if (folder == nullptr) return;
        std::filesystem::create_directories(folder);
        scratch_.write("shot.png", browser_->screenshot());
        std::filesystem::copy_file(scratch_.path("shot.png"), std::filesystem::path(folder) / (name + ".png"),
                                   std::filesystem::copy_options::overwrite_existing);
    }
};

TEST_F(TransferPage, DrawsTheSameMeshTwiceInTheSameWay) {
    // A mesh makes a flat map of itself: both pictures are that of the mesh alone.
    open_report("crate_low.glb crate_low.glb --extent 256");
    EXPECT_LT(differing(canvas_of(".stage.mesh"), canvas_of(".stage.beside")), 0.002);
    point_at(0.3, 0.6);
    point_at(0.7, 0.4, true);
    EXPECT_LT(differing(canvas_of(".stage.mesh"), canvas_of(".stage.beside")), 0.002);
    const Agreement found = compare_with_command("beside itself");
    EXPECT_GE(found.share, 0.99) << found.command;
}

TEST_F(TransferPage, TurnsBothMeshesByEither) {
    open_report("crate_low.glb crate_high.glb --extent 512 --rays straight");
    leave_picture("transfer-crate");
    const auto low = canvas_of(".stage.mesh"), high = canvas_of(".stage.beside");
    EXPECT_LT(differing(low, high), 0.15) << "they look alike";
    stage_ = ".stage.beside";
    point_at(0.3, 0.5);
    point_at(0.6, 0.3, true);
    stage_ = ".stage.mesh";
    EXPECT_EQ(command().find("--camera 30,20"), std::string::npos) << command();
    EXPECT_GT(differing(canvas_of(".stage.mesh"), low), 0.05);
    EXPECT_GT(differing(canvas_of(".stage.beside"), high), 0.05);
    EXPECT_LT(differing(canvas_of(".stage.mesh"), canvas_of(".stage.beside")), 0.15);
    const Agreement found = compare_with_command("turned by the other mesh");
    EXPECT_GE(found.share, 0.99) << found.command;
    EXPECT_EQ(js("document.querySelectorAll('.stage.beside .panel > *').length").get<int>(), 0);
    js("document.querySelector('.stage.beside canvas').focus({preventScroll: true})");
    browser_->press_key("Home");
    settle();
    EXPECT_NE(command().find("--camera 30,20"), std::string::npos) << command();
}

TEST_F(TransferPage, ShowsMissedTexelsInRed) {
    open_report("crate_low.glb crate_high.glb --extent 256 --front 1% --back 1%");
    leave_picture("transfer-missed");
    const auto red = canvas_of(".stage.mesh");
    set_control("missed", "");
    const auto filled = canvas_of(".stage.mesh");
    EXPECT_GT(differing(red, filled), 0.01);
    const Agreement found = compare_with_command("as they were filled");
    EXPECT_GE(found.share, 0.99) << found.command;
    EXPECT_NE(text(".facts").find("of those that longer rays can hit"), std::string::npos);
    for (const int width : {1160, 390}) {
        browser_->set_viewport(width, 900);
        open("page.html");
        wait_for_light();
        EXPECT_LE(js("document.documentElement.scrollWidth").get<int>(), width) << "nothing hangs over";
        leave_picture(fmt::format("transfer-{}", width));
    }
}

}  // namespace
}  // namespace tex::browser
