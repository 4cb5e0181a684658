// SPDX-License-Identifier: Apache-2.0
// page.h: a page of --report in a browser, and its canvases beside the pictures of the commands that it states.

#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/file.h>

#include "browser/browser.h"
#include "cli/program.h"

namespace tex::browser {

// Codes of 255 that a canvas and preview-normals may differ by.
inline constexpr int kCodes = 3;

// How far a canvas and the picture of its command agree.
struct Agreement {
    std::string command;
    double share = 0.0;  // of all pixels, differ by at most kCodes
};

class PageTest : public testing::Test {
protected:
    void SetUp() override {
        if (Browser::program().empty()) GTEST_SKIP() << "no Chromium here";
        std::filesystem::create_directory(scratch_.path("browser"));
        browser_ = std::make_unique<Browser>(scratch_.path("browser"));
        browser_->set_viewport(1280, 1000);
    }
    void TearDown() override {
        if (!browser_) return;
        for (const std::string& complaint : browser_->complaints()) ADD_FAILURE() << complaint;
    }

    int shell(const std::string& script) {
        const cli::Ran ran = cli::shell(scratch_, "set -e; cp -n " TEX_SOURCE_DIR "/samples/*.png .; " + script);
        if (ran.code > 1) ADD_FAILURE() << script << ": " << ran.err;
        return ran.code;
    }
    double open(const std::string& page) { return browser_->open(scratch_.path(page)); }
    Browser::Json js(const std::string& expression) { return browser_->evaluate(expression); }
    // `selector` is inside of the stage that is tested.
    [[nodiscard]] std::string in_stage(const std::string& selector) const {
        return "document.querySelector('" + stage_ + " " + selector + "')";
    }
    std::string text(const std::string& selector) {
        return js("document.querySelector('" + selector + "').textContent").get<std::string>();
    }
    std::string command() { return text(stage_ + " .command"); }

    // The first stage of its kind, in view and drawn.
    void wait_for_light() {
        js("document.querySelector('" + stage_ + "').scrollIntoView({behavior: 'instant', block: 'start'})");
        EXPECT_TRUE(browser_->wait_for("!!" + in_stage("canvas") + " && !" + in_stage(".view") + ".hidden && " +
                                       in_stage(".command") + ".textContent !== ''"));
    }
    // Waits until the canvas shows what the controls say: the command line is written after the picture.
    void settle() {
        js("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done, 30))))");
    }

    // The mouse to a place of the canvas, 0 to 1 from its upper left corner.
    void point_at(double x, double y, bool held = false) {
        const Browser::Json box = js("(() => { const b = " + in_stage("canvas") +
                                     ".getBoundingClientRect(); return [b.x, b.y, b.width, b.height]; })()");
        browser_->move_mouse(box[0].get<double>() + x * box[2].get<double>(),
                             box[1].get<double>() + y * box[3].get<double>(), held);
        settle();
    }
    // A control of the panel.
    void set_control(const std::string& name, const std::string& value) {
        js("(() => { const c = " + in_stage("[name=" + name + "]") + "; c.value = '" + value +
           "'; c.dispatchEvent(new Event(c.type === 'range' ? 'input' : 'change')); })()");
        settle();
    }

    // The canvas's red channel, row by row, and its extent.
    std::vector<int> canvas(Extent& extent) {
        const Browser::Json got =
            js("(() => { const c = " + in_stage("canvas") +
               ", d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;"
               " let t = ''; for (let k = 0; k < d.length; k += 4) t += String.fromCharCode(97 + (d[k] >> 4), 97 + "
               "(d[k] & 15));"
               " return [c.width, c.height, t]; })()");
        extent = {got[0].get<int>(), got[1].get<int>()};
        const auto letters = got[2].get<std::string>();
        std::vector<int> codes;
        for (std::size_t k = 0; k + 1 < letters.size(); k += 2)
            codes.push_back((letters[k] - 97) << 4 | (letters[k + 1] - 97));
        return codes;
    }

    // Runs the command that the page shows and compares its picture with the canvas.
    Agreement compare_with_command(const std::string& what) {
        Agreement found;
        found.command = command();
        shell(found.command + " --no-sync");
        const auto image = read_image(scratch_.path("lit.png"));
        Extent extent;
        const std::vector<int> codes = canvas(extent);
        if (!image || image->extent() != extent) {
            ADD_FAILURE() << found.command;
            return found;
        }
        std::int64_t within = 0;
        int most = 0;
        for (int j = 0; j < extent.height; ++j) {
            for (int i = 0; i < extent.width; ++i) {
                const auto at =
                    static_cast<std::size_t>(j) * static_cast<std::size_t>(extent.width) + static_cast<std::size_t>(i);
                const int expected = static_cast<int>(image->planes[0].at(i, j) * 255.0f + 0.5f);
                const int difference = std::abs(codes[at] - expected);
                within += difference <= kCodes ? 1 : 0;
                most = std::max(most, difference);
            }
        }
        found.share = static_cast<double>(within) / static_cast<double>(extent.texels());
        std::cout << what << ": " << text(stage_ + " .panel > .remark") << " within " << kCodes
                  << " codes: " << found.share << ", most " << most << "\n";
        return found;
    }

    Scratch scratch_;
    std::unique_ptr<Browser> browser_;
    std::string stage_ = ".stage";
};

}  // namespace tex::browser
