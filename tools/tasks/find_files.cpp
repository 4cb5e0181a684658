// SPDX-License-Identifier: Apache-2.0

#include "tasks/find_files.h"

#include <optional>
#include <string_view>

#include "cli/file_status.h"

namespace tex::cli {
namespace {

constexpr const char* kWildcards = "*?[{";

}  // namespace

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
