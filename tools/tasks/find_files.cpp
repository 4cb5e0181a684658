// SPDX-License-Identifier: Apache-2.0

#include "tasks/find_files.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string_view>

#include "cli/file_status.h"
#include "cli/text.h"

namespace tex::cli {
namespace {

constexpr const char* kWildcards = "*?[{";

// Without their dots.
constexpr std::string_view kPictureExtensions[] = {"dds",  "ktx2", "ktx",  "astc", "png",  "exr", "tga",
                                                   "bmp",  "jpg",  "jpeg", "tif",  "tiff", "hdr", "psd",
                                                   "webp", "jp2",  "gif",  "dpx",  "sgi",  "tx"};
constexpr std::string_view kHeightExtensions[] = {"asc", "hgt", "bil", "flt", "r16", "r32", "raw"};
constexpr std::string_view kModelExtensions[] = {"glb", "gltf"};

template <std::size_t N>
bool has_one_of(const std::string_view (&extensions)[N], const std::string& path) {
    const std::size_t dot = path.rfind('.');
    if (dot == std::string::npos || path.find('/', dot) != std::string::npos) return false;
    return std::find(extensions, extensions + N, lower_case(path.substr(dot + 1))) != extensions + N;
}

bool is_hidden(std::string_view path) {
    while (path.ends_with('/')) path.remove_suffix(1);
    const std::size_t slash = path.rfind('/');
    return path.substr(slash == std::string_view::npos ? 0 : slash + 1).starts_with('.');
}

}  // namespace

bool is_picture(const std::string& path) { return has_one_of(kPictureExtensions, path); }
bool is_height_file(const std::string& path) { return has_one_of(kHeightExtensions, path); }

Result<FolderPictures> pictures_below(const std::string& folder) {
    const Glob all("**");
    std::optional<Error> failed;
    FileSearch search;
    search.globs = {&all};
    search.skip = [](const std::string& path) { return is_hidden(path); };
    search.unreadable = [&](const std::string& path, const std::string& reason) {
        if (!failed) failed = Error{ErrorCode::io, path, "cannot be read: " + reason};
    };
    FolderPictures found;
    const std::string before = folder == "." ? "" : folder.ends_with('/') ? folder : folder + "/";
    for (const FoundFile& file : find_files(folder == "." ? "" : folder, search)) {
        if (is_hidden(file.path)) continue;
        if (is_picture(file.path) || has_one_of(kModelExtensions, file.path))
            found.files.push_back(before + file.path);
        else
            ++found.others;
    }
    if (failed) return *failed;
    if (found.files.empty())
        return Error{ErrorCode::io, folder, "no file in this folder is a picture, by its extension"};
    return found;
}

bool is_pattern(const std::string& name) {
    const std::size_t first = name.find_first_of(kWildcards);
    if (first == std::string::npos || status_of_link(name)) return false;
    // A bracket without its end is a letter, as in a shell.
    return name[first] == '*' || name[first] == '?' ||
           name.find(name[first] == '[' ? ']' : '}', first) != std::string::npos;
}

Result<std::vector<std::string>> files_matching(const std::string& pattern) {
    // The folder before the first part with a wildcard.
    const std::size_t slash = pattern.rfind('/', pattern.find_first_of(kWildcards));
    const std::string folder = slash == std::string::npos ? std::string() : pattern.substr(0, slash + 1);
    const Glob glob(std::string_view(pattern).substr(folder.size()));
    std::optional<Error> failed;
    FileSearch search;
    search.globs = {&glob};
    search.skip = [](const std::string&) { return false; };
    search.unreadable = [&](const std::string& path, const std::string& reason) {
        if (!failed) failed = Error{ErrorCode::io, path, "cannot be read: " + reason};
    };
    std::vector<std::string> files;
    for (const FoundFile& file : find_files(folder.size() > 1 ? folder.substr(0, slash) : folder, search))
        files.push_back(folder + file.path);
    if (files.empty() && !failed) return Error{ErrorCode::io, pattern, "no file matches this pattern"};
    if (failed) return *failed;
    return files;
}

}  // namespace tex::cli
