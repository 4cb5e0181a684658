// SPDX-License-Identifier: Apache-2.0
// Packages of npm that tests of peers run.
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

namespace tex {

// The folder of the build that holds node_modules with the packages, installed by the first test that asks; empty if
// npm or its registry is missing. Each set of packages has a folder by its name. npm installs into a folder of this
// process, which gets the name when it is whole: npm changes and prunes what stands in a folder, and other processes
// may be running its programs.
inline std::string npm_folder(const std::string& name, const std::string& packages) {
    namespace fs = std::filesystem;
    const fs::path root = fs::path(TEX_BINARY_DIR) / "npm-packages";
    const fs::path place = root / name;
    if (fs::exists(place)) return place.string();
    const auto succeeds = [](const std::string& command) {
        return std::system((command + " >/dev/null 2>&1 </dev/null").c_str()) == 0;
    };
    if (!succeeds("command -v npm")) return {};
    fs::create_directories(root);
    const std::string own = (root / (name + "." + std::to_string(getpid()))).string();
    std::error_code error;
    fs::remove_all(own, error);  // of a process that was killed
    if (succeeds("timeout 300 npm install --no-audit --no-fund --prefix '" + own + "' " + packages))
        fs::rename(own, place, error);  // fails if another process was first
    fs::remove_all(own, error);
    return fs::exists(place) ? place.string() : std::string();
}

}  // namespace tex
