// SPDX-License-Identifier: Apache-2.0
// manifest.h: normals.toml, which says how a tree of textures is made. See normals.toml(5).
//
// Rooms of tools/tree: manifest and glob say what is wanted; recipe turns a rule into commands; work lists the
// textures; digest, state and cache know what is up to date; builder makes the rest. None of them knows an option of a
// command by its name, and none looks at a texel.

#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tex::cli {

// A place in the manifest. Both count from 1.
struct TextPosition {
    int line = 1;
    int column = 1;
};

// One option of a command: "height-range = 0.05".
struct OptionSetting {
    std::string key;                  // the option's name without its dashes
    std::vector<std::string> values;  // as they would be typed, one for each time that the option is given
    bool is_list = false;             // an array, which stands for several values or for one with commas
    bool is_flag = false;             // true or false
    bool is_on = true;                // of a flag
    bool is_default = false;          // from [defaults]
    TextPosition place;
};
using Settings = std::vector<OptionSetting>;  // sorted by key

struct StepSettings {
    std::string command;  // "bake", for bake-normals
    Settings settings;
    TextPosition place;
};

struct OutputSettings {
    std::string name;  // a pattern
    Settings settings;
    TextPosition place;
};

struct RuleSettings {
    std::vector<std::string> match;
    std::vector<std::string> exclude;
    std::vector<std::string> unless;  // see beside.h
    std::string out_dir;
    std::vector<StepSettings> steps;
    std::vector<OutputSettings> outputs;
    Settings check;
    TextPosition place;
};

struct Manifest {
    std::string path;  // for messages
    std::optional<int> output_version;
    std::vector<RuleSettings> rules;
};

// Throws a UsageError: "PATH: line L, column C: REASON".
[[noreturn]] void fail_at(const std::string& path, const TextPosition& place, const std::string& reason);

// Reads a manifest. `commands` are the names that a step may have. Throws UsageError. The keys of steps are not checked
// here, because only the commands know them.
[[nodiscard]] Manifest parse_manifest(const std::string& path, const std::string& text,
                                      const std::vector<std::string>& commands);

}  // namespace tex::cli
