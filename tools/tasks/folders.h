// SPDX-License-Identifier: Apache-2.0
// folders.h: the folders of outputs.

#pragma once

#include <optional>
#include <string>
#include <system_error>

#include <tex/types.h>

namespace tex::cli {

// Whether `path` can only be a folder: it is one, or ends in a slash.
[[nodiscard]] bool is_folder(const std::string& path);

// Whether both are the same name but for ".": "a.png" and "./a.png".
[[nodiscard]] bool is_same_name(const std::string& path, const std::string& other);

// Creates the folders above `file` that are not there. Errors: io.
[[nodiscard]] Result<void> create_folders_of(const std::string& file);

[[nodiscard]] Error no_folder_error(const std::string& folder, const std::error_code& error);

// `path` relative to `folder` (empty: the working directory), if it is there: by name or, if names do not show it,
// through links. The folder itself is ".".
[[nodiscard]] std::optional<std::string> path_below(const std::string& folder, const std::string& path);

}  // namespace tex::cli
