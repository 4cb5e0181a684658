// SPDX-License-Identifier: Apache-2.0
// path_names.h: the parts of a path, as the system separates them.

#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace tex::inline v1 {

inline constexpr bool kHasBackslashes = std::filesystem::path::preferred_separator != '/';
// What separates the names in a path.
inline constexpr std::string_view kSeparators = kHasBackslashes ? "/\\" : "/";

// The text of a path, with slashes on every system.
inline std::string slashed(const std::filesystem::path& path) {
    if constexpr (kHasBackslashes) return path.generic_string();
    return path.string();
}

// Where the last name in a path begins: after the last separator. (A drive is a folder: "C:a.png" is a.png of the
// current folder of C.)
inline std::size_t name_begin(std::string_view path) {
    const std::size_t separator = path.find_last_of(kHasBackslashes ? "/\\:" : "/");
    return separator == std::string_view::npos ? 0 : separator + 1;
}

// Whether a path is the same wherever the process is. A path of a drive without a folder ("C:a.png") and one of the
// current drive ("\a.png") count as such, because they cannot be put below a folder.
inline bool is_absolute(std::string_view path) {
    return (!path.empty() && kSeparators.find(path.front()) != std::string_view::npos) ||
           (kHasBackslashes && path.size() > 1 && path[1] == ':');
}

}  // namespace tex::inline v1
