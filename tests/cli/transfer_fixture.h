// SPDX-License-Identifier: Apache-2.0
// transfer_fixture.h: runs transfer-normals on two crates.

#pragma once

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tex/tex.h>
#include <nlohmann/json.hpp>

#include "cli/meshes.h"
#include "cli/program.h"

namespace tex::cli {

class TransferTest : public testing::Test {
protected:
    TransferTest() {
        for (const std::string name : {"crate_low.glb", "crate_high.glb"}) scratch_.add_sample(name, name);
        scratch_.write("sheet.obj", kSheetObj);
    }

    Ran go(std::vector<std::string> arguments) const {
        arguments.insert(arguments.end(), {"--extent", "96", "--no-sync"});
        return run(scratch_, "transfer-normals", arguments);
    }
    Ran does(const std::vector<std::string>& arguments) const {
        Ran ran = go(arguments);
        EXPECT_EQ(ran.code, 0) << ran.err;
        EXPECT_EQ(ran.err, "");
        return ran;
    }
    nlohmann::json reports(std::vector<std::string> arguments, int code = 0) const {
        arguments.insert(arguments.end(), {"--json", "--quiet"});
        const Ran ran = go(arguments);
        EXPECT_EQ(ran.code, code) << ran.err;
        return nlohmann::json::parse(ran.out);
    }
    void refuses(const std::vector<std::string>& arguments, int code, const std::string& part) const {
        const auto before = scratch_.list();
        const Ran ran = go(arguments);
        EXPECT_EQ(ran.code, code) << ran.err;
        EXPECT_NE(ran.err.find(part), std::string::npos) << ran.err;
        EXPECT_EQ(ran.err.find('\n'), ran.err.size() - 1) << ran.err;
        EXPECT_EQ(scratch_.list(), before);
    }
    NormalMap map(const std::string& name, std::size_t level = 0) const {
        const auto texture = read_texture(scratch_.path(name));
        EXPECT_TRUE(texture) << name;
        auto chain = unpack(*texture);
        EXPECT_TRUE(chain) << name;
        return std::move(chain->levels[level]);
    }
    // What transfer() makes of the crates, with as many texels as the command.
    Result<TransferredMaps> transferred(const TransferOptions& options) const {
        const auto low = read_mesh(scratch_.path("crate_low.glb"));
        auto high = read_mesh(scratch_.path("crate_high.glb"));
        if (!low || !high) return (low ? high : low).error();
        MeshSelection selection;
        selection.in_scene = true;
        const auto selected = select_part(*low, selection);
        const auto parts = parts_in_scene(std::move(*high));
        if (!selected || !parts) return selected ? parts.error() : selected.error();
        return transfer({96, 96}, {selected->part, selected->tangents}, *parts, options);
    }

    Scratch scratch_;
};

}  // namespace tex::cli
