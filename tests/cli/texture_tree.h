// SPDX-License-Identifier: Apache-2.0
// texture_tree.h: a folder with a manifest, for tests of build-normals.

#pragma once

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace tex::cli {

namespace fs = std::filesystem;

inline constexpr const char* kManifest = R"(version = 1
[defaults]
out-dir = "out"
[[rule]]
match = "shared/*.png"
steps = [ { bake = { bumpiness = 2 } } ]
[[rule]]
match = "art/**/*_h.{png,tif}"
exclude = "art/wip/**"
name = "{dir}/{stem:-_h}_n.dds"
steps = [ { bake = { bumpiness = 4 } }, { blend = { detail = "out/shared/grain.dds", tiling = 3 } }, { mip = {} } ]
outputs = [ {}, { format = "bc5", y = "down", name = "{dir}/{stem:-_h}_ue.ktx2" } ]
)";

class TextureTree : public testing::Test {
protected:
    TextureTree() {
        scratch_.write("normals.toml", kManifest);
        for (const char* name : {"art/wall_h.png", "art/sub/floor_h.PNG", "art/wip/new_h.png", "shared/grain.png"}) {
            fs::create_directories(fs::path(scratch_.path(name)).parent_path());
            scratch_.add_sample(name[0] == 's' ? "waves.png" : "ramp.png", name);
        }
    }
    // Runs it. The results are what it did to each input: "made", "current" ...
    Ran build(std::vector<std::string> arguments = {}, const Setting& setting = {}) {
        arguments.insert(arguments.end(), {"--json", "--no-sync"});
        const Ran ran = run(scratch_, "build-normals", arguments, setting);
        done_.clear();
        for (const std::string& line : lines_of(ran.out)) {
            const auto result = nlohmann::json::parse(line, nullptr, false);
            if (result.is_discarded() || !result.contains("input")) continue;
            done_[result.value("input", std::string())] = result.value("status", std::string("failed"));
        }
        return ran;
    }
    [[nodiscard]] std::size_t count(const std::string& status) const {
        return static_cast<std::size_t>(
            std::count_if(done_.begin(), done_.end(), [&](const auto& done) { return done.second == status; }));
    }
    // All outputs and their contents.
    [[nodiscard]] std::map<std::string, std::string> outputs() const {
        std::map<std::string, std::string> all;
        for (const std::string& name : scratch_.list()) {
            if (name.starts_with("out/") && fs::is_regular_file(scratch_.path(name))) all[name] = scratch_.read(name);
        }
        return all;
    }

    Scratch scratch_;
    std::map<std::string, std::string> done_;
};

}  // namespace tex::cli
