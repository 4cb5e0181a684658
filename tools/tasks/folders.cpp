// SPDX-License-Identifier: Apache-2.0

#include "tasks/folders.h"

#include <filesystem>

#include "cli/file_status.h"
#include "files/path_names.h"
#include "files/system_error.h"

namespace tex::cli {
namespace {

namespace fs = std::filesystem;

std::optional<std::string> relative_below(const fs::path& folder, const fs::path& path) {
    const fs::path relative = path.lexically_relative(folder);
    if (relative.empty() || *relative.begin() == "..") return std::nullopt;
    return slashed(relative);
}

// Without a slash at its end.
fs::path absolute_path(const std::string& path) {
    fs::path whole = fs::absolute(path.empty() ? "." : path).lexically_normal();
    return whole.has_filename() ? whole : whole.parent_path();
}

}  // namespace

bool is_folder(const std::string& path) {
    if (path.ends_with('/')) return true;
    const auto status = status_of(path);
    return status && status->kind == FileKind::folder;
}

bool is_same_name(const std::string& path, const std::string& other) {
    // A ".." after a link leads elsewhere than the name before it says.
    const auto plain = [](const std::string& name) {
        std::filesystem::path parts;
        for (const auto& part : std::filesystem::path(name)) {
            if (part != ".") parts /= part;
        }
        return parts;
    };
    return path == other || plain(path) == plain(other);
}

Result<void> create_folders_of(const std::string& file) {
    const fs::path folder = fs::path(file).parent_path();
    const std::error_code error = folder.empty() ? std::error_code() : create_folders(slashed(folder));
    return error ? Result<void>(no_folder_error(slashed(folder), error)) : Result<void>();
}

Error no_folder_error(const std::string& folder, const std::error_code& error) {
    return {ErrorCode::io, folder, "cannot create this folder: " + system_reason(error.value()),
            is_no_space(error.value()) ? ErrorDetail::no_space : ErrorDetail::none};
}

std::optional<std::string> path_below(const std::string& folder, const std::string& path) {
    const fs::path of_folder = absolute_path(folder), of_path = absolute_path(path);
    if (auto relative = relative_below(of_folder, of_path)) return relative;
    std::error_code error;
    const fs::path real_folder = fs::weakly_canonical(of_folder, error);
    const fs::path named = fs::weakly_canonical(of_path.parent_path(), error) / of_path.filename();
    if (auto relative = relative_below(real_folder, named)) return relative;
    return relative_below(real_folder, fs::weakly_canonical(of_path, error));
}

}  // namespace tex::cli
