// SPDX-License-Identifier: Apache-2.0
// find_files.h: the files of a tree that match patterns.

#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <tex/types.h>

#include "cli/glob.h"

namespace tex::cli {

struct FoundFile {
    std::string path;  // relative to the folder that was searched
    std::int64_t size = 0;
};

// Takes a folder below the root: "" or a path that ends with "/".
using FolderVisitor = std::function<void(const std::string& folder)>;

struct FileSearch {
    std::vector<const Glob*> globs;
    // Whether a folder is left out. The path ends with "/".
    std::function<bool(const std::string& folder)> skip;
    // Called with each folder before it is read; may be empty.
    FolderVisitor entered;
    // Called with each file in such a folder that matches no pattern; may be empty.
    std::function<void(const std::string& path)> passed_over = {};
    // Called for each folder that cannot be read.
    std::function<void(const std::string& folder, const std::string& reason)> unreadable;
};

// The regular files below `root` (empty: the working directory) that match a pattern, sorted by path. Links to files
// and folders are followed; a link to a folder that contains it is not.
[[nodiscard]] std::vector<FoundFile> find_files(const std::string& root, const FileSearch& search);

// Whether a shell would take the name of an input for a pattern, and no file has that name.
[[nodiscard]] bool is_pattern(const std::string& name);

// The files that match a pattern (cli/glob.h), sorted; its first parts may be absolute or "..". Errors: io: there is
// none, or a folder cannot be read. Throws UsageError, as Glob.
[[nodiscard]] Result<std::vector<std::string>> files_matching(const std::string& pattern);

// Whether a file of this name may hold normals, or heights: by the extension.
[[nodiscard]] bool is_picture(const std::string& path);
// Whether it holds heights alone, in a file type without colours.
[[nodiscard]] bool is_height_file(const std::string& path);

// The pictures and glTF models in a folder and those below it, by their extensions, and the number of other files.
struct FolderPictures {
    std::vector<std::string> files;
    std::int64_t others = 0;
};

// Files and folders whose names begin with a dot are not looked at. Errors: io: there is none, or a folder cannot be
// read.
[[nodiscard]] Result<FolderPictures> pictures_below(const std::string& folder);

}  // namespace tex::cli
