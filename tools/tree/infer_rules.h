// SPDX-License-Identifier: Apache-2.0
// infer_rules.h: patterns of names that agree with what files hold.

#pragma once

#include <string>
#include <vector>

namespace tex::cli {

// A file of a tree, and the settings that it needs.
struct SettingsOfFile {
    std::string path;               // relative to the root, with slashes
    std::string settings;           // empty: any of `also`
    std::vector<std::string> also;  // other settings that are right for it, too
    bool is_left_out = false;       // a pattern may match it, and then names it as an exception
};

// A rule for the files that match.
struct InferredRule {
    std::vector<std::string> match, exclude;  // patterns, as Glob has them
    std::string settings;
    std::vector<std::string> files;  // that it is for
};

// Rules for all files with settings, one for each kind of settings that occurs. A pattern is used only if all files of
// the tree that it matches are for its rule or are left out. From the widest to the narrowest: the end of the name in
// all folders ("**/*_n.png"), in one folder ("rock/*_n.png"), a whole folder ("rock/*.png"), the file itself. `files`
// holds the whole tree: files without settings and without `also` are for no rule.
[[nodiscard]] std::vector<InferredRule> infer_rules(const std::vector<SettingsOfFile>& files);

// The end of a file's name that says what it holds: "_n" of "rock_n.png", "Normal" of "rockNormal.tga"; empty if there
// is none.
[[nodiscard]] std::string name_end(const std::string& path);

// The path of the file without name_end() and extension: what maps of one material share.
[[nodiscard]] std::string name_beginning(const std::string& path);

// What a file's name says that it holds: "rock_Normal.tga", "rock-nrm.png", "heightmap.png".
enum class NamedAs { other, normals, heights };
[[nodiscard]] NamedAs named_as(const std::string& path);

}  // namespace tex::cli
