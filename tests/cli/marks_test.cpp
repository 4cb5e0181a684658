// SPDX-License-Identifier: Apache-2.0
// Commands keep what is known about a map: a file that one command writes says where y points, the next command
// believes it, and check-normals finds that the file tells the truth.

#include <gtest/gtest.h>
#include <tex/tex.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "cli/unmarked.h"

namespace tex::cli {
namespace {

struct Output {
    const char* name;  // of the file
    const char* format;
    const char* layout;
};

constexpr Output kOutputs[] = {
    {"a.dds", "dxt5nm", "dxt5nm"}, {"b.dds", "bc5", "rg"},     {"c.ktx2", "bc5-snorm", "rg"}, {"d.ktx2", "half", "rgb"},
    {"e.png", "rgb8", "rgb"},      {"f.png", "ag8", "dxt5nm"}, {"g.exr", "half", "rgb"},      {"h.tif", "rgb16", "rgb"},
    {"i.tga", "rgb8", "rgb"},      {"j.jpg", "rgb8", "rgb"},   {"k.dds", "float", "rgb"},     {"l.tif", "float", "rgb"},
};

class Marks : public testing::Test {
protected:
    Marks() { scratch_.add_sample("waves.png", "waves.png"); }
    void does(const std::string& command, std::vector<std::string> arguments, const std::string& said = {}) {
        arguments.emplace_back("--no-sync");
        const Ran ran = run(scratch_, command, arguments);
        EXPECT_EQ(ran.code, 0) << command << " " << arguments[0] << ": " << ran.err;
        if (said.empty()) {
            EXPECT_EQ(without_notes(ran.err), "") << command << " " << arguments[0];
        }
        EXPECT_NE(ran.err.find(said), std::string::npos) << ran.err;
    }
    // What a file states: "rgb +y", "rgb" or nothing.
    [[nodiscard]] std::string stated(const std::string& name) const {
        const auto texture = read_texture(scratch_.path(name));
        if (!texture) return texture.error().message();
        if (!texture->swizzle_known) return texture->y_known ? "y alone" : "";
        std::string text = layout_name(texture->swizzle);
        if (texture->y_known) text += texture->y_axis == YAxis::up ? " +y" : " -y";
        return text;
    }
    // Removes what a file states.
    void forget(const std::string& name) const { remove_marks(scratch_, name); }
    // The findings of check-normals, by file, except those of JPEG's losses.
    [[nodiscard]] std::string findings(std::vector<std::string> names, const std::string& y) const {
        names.insert(names.end(), {"--json", "--require", "y=" + y, "--disable", "N304"});
        std::string all;
        for (const std::string& line : lines_of(run(scratch_, "check-normals", names).out)) {
            const auto json = nlohmann::json::parse(line);
            if (json.contains("error")) all += line;
            for (const auto& finding : json["findings"])
                all += json["input"].get<std::string>() + ": " + finding["message"].get<std::string>() + "\n";
        }
        return all;
    }
    Scratch scratch_;
};

TEST_F(Marks, SurviveEveryPathFromFileToFile) {
    for (const std::string y : {"up", "down"}) {
        const std::string sign = y == "up" ? " +y" : " -y";
        std::vector<std::string> written;
        for (const Output& first : kOutputs) {
            const std::string from = y + "-" + first.name;
            does("bake-normals", {"waves.png", "-o", from, "--bumpiness", "2", "--format", first.format, "--y", y});
            EXPECT_EQ(stated(from), first.layout + sign) << from;
            written.push_back(from);
        }
        for (std::size_t k = 0; k < std::size(kOutputs); ++k) {
            const Output& first = kOutputs[k];
            const Output& second = kOutputs[(k + (y == "up" ? 5 : 7)) % std::size(kOutputs)];
            const std::string from = y + "-" + first.name;
            const std::string to = std::string("from-") + first.name[0] + "-" + y + "-" + second.name;
            does("pack-normals", {from, "-o", to, "--format", second.format});
            EXPECT_EQ(stated(to), second.layout + sign) << to;
            written.push_back(to);
        }
        EXPECT_EQ(findings(written, y), "");
    }
}

TEST_F(Marks, SurviveEveryCommand) {
    for (const std::string y : {"up", "down"}) {
        const std::string sign = y == "up" ? " +y" : " -y";
        for (const std::string type : {".dds", ".ktx2", ".png", ".exr", ".tif"}) {
            const std::string from = y + type;
            std::vector<std::string> written;
            const auto makes = [&](const std::string& command, const std::vector<std::string>& more) {
                const std::string to = command + "-" + from;
                std::vector<std::string> arguments = {from, "-o", to};
                arguments.insert(arguments.end(), more.begin(), more.end());
                does(command, arguments);
                EXPECT_NE(stated(to).find(sign), std::string::npos) << to << ": " << stated(to);
                written.push_back(to);
            };
            does("bake-normals", {"waves.png", "-o", from, "--bumpiness", "2", "--y", y});
            if (can_hold_levels(*container_of(from))) makes("mip-normals", {});
            makes("scale-normals", {"--scale", "0.5"});
            makes("unpack-normals", {});
            makes("pack-normals", {});
            makes("blend-normals", {"--detail", from, "--tiling", "2"});
            EXPECT_EQ(findings(written, y), "");
        }
    }
}

TEST_F(Marks, StateNoYThatNobodyKnows) {
    does("bake-normals", {"waves.png", "-o", "n.png", "--bumpiness", "2", "--y", "down"});
    forget("n.png");
    EXPECT_EQ(stated("n.png"), "");
    for (const std::string to : {"x.dds", "x.ktx2", "x.png", "x.exr", "x.tif"}) {
        does("pack-normals", {"n.png", "-o", to});
        EXPECT_EQ(stated(to).find('y'), std::string::npos) << to << stated(to);
        EXPECT_NE(stated(to), "");
        does("pack-normals", {"n.png", "-o", to, "--y-in", "down"});
        EXPECT_NE(stated(to).find(" -y"), std::string::npos) << to << stated(to);
        does("pack-normals", {"n.png", "-o", to, "--y-in", "down", "--y", "up"});
        EXPECT_NE(stated(to).find(" +y"), std::string::npos) << to << stated(to);
    }
    const Ran ran = run(scratch_, "pack-normals", {"n.png", "-o", "x.dds", "--json", "--no-sync"});
    EXPECT_TRUE(nlohmann::json::parse(ran.out)["y"].is_null()) << ran.out;
}

// A direction that is only assumed, and has an effect, is compared with what the texels show.
TEST_F(Marks, AreMissedWhereTheTexelsContradictAnAssumption) {
    const std::string other = "n.png: green is taken to point up, but the texels show the other direction";
    does("bake-normals", {"waves.png", "-o", "n.png", "--y", "down", "--bumpiness", "4"});
    does("bake-normals", {"waves.png", "-o", "detail.png", "--bumpiness", "2"});
    for (const std::string to : {"x.dds", "x.exr"}) {
        does("pack-normals", {"n.png", "-o", to, "--y", "up"});
        does("blend-normals", {"n.png", "detail.png", "-o", to});
    }
    does("preview-normals", {"n.png", "-o", "seen.png"});
    forget("n.png");
    for (const std::string to : {"x.dds", "x.exr"}) {
        does("pack-normals", {"n.png", "-o", to});  // nothing depends on y
        does("scale-normals", {"n.png", "-o", to, "--scale", "2"});
        does("pack-normals", {"n.png", "-o", to, "--y", "up"}, other);
        does("pack-normals", {"n.png", "-o", to, "--y", "up", "--y-in", "down"});
        does("scale-normals", {"n.png", "-o", to, "--y", "down", "--scale", "-2"}, other);
        does("blend-normals", {"n.png", "detail.png", "-o", to}, other);
        does("blend-normals", {"n.png", "detail.png", "-o", to, "--tiling", "2", "--extent", "96x96"}, other);
        does("blend-normals", {"detail.png", "n.png", "-o", to}, other);
        does("blend-normals", {"detail.png", "n.png", "-o", to, "--tiling", "3"}, other);
        does("blend-normals", {"n.png", "n.png", "-o", to});  // all maps agree
    }
    does("preview-normals", {"n.png", "-o", "seen.png"}, other);
    does("preview-normals", {"n.png", "-o", "seen.png", "--y-in", "down"});
    does("bake-normals", {"waves.png", "-o", "n.png", "--bumpiness", "2"});
    forget("n.png");
    does("pack-normals", {"n.png", "-o", "x.dds", "--y", "down"});
}

// Everything that a mark states is known, so nothing is guessed from the texels.
TEST_F(Marks, LeaveNothingToGuess) {
    does("bake-normals", {"waves.png", "-o", "n.dds", "--bumpiness", "2"});
    does("bake-normals", {"waves.png", "-o", "n.png", "--bumpiness", "2", "--format", "ag8"});
    does("preview-normals", {"n.dds", "-o", "seen.png"});
    does("preview-normals", {"n.png", "-o", "seen.png"});
    forget("n.dds");
    does("preview-normals", {"n.dds", "-o", "seen.png"}, "guessed dxt5nm");
}

}  // namespace
}  // namespace tex::cli
