// SPDX-License-Identifier: Apache-2.0

#include "tasks/file_table.h"

#include <filesystem>
#include <system_error>

#include "cli/file_status.h"
#include "files/path_names.h"

namespace tex::cli {
namespace {

namespace fs = std::filesystem;

// What the last component of `path` leads to as a link, even if nothing is there.
fs::path target_of_links(const std::string& path) {
    fs::path at = path;
    constexpr int kMostLinks = 40;  // the kernel's limit; opening a file behind more links is an error
    for (int k = 0; k < kMostLinks; ++k) {
        std::error_code error;
        const fs::path target = fs::read_symlink(at, error);
        if (error) break;
        at = at.parent_path() / target;
    }
    return at;
}

}  // namespace

FileKey place_of_file(const std::string& path) {
    const fs::path whole(path);
    fs::path folder = whole.parent_path(), rest = whole.filename();
    while (true) {
        if (const auto status = status_of(folder.empty() ? "." : slashed(folder)))
            return {status->device, status->inode, key_of_name(slashed(rest.lexically_normal()))};
        if (folder.empty() || folder == folder.parent_path())
            return {0, 0, key_of_name(slashed(whole.lexically_normal()))};
        rest = folder.filename() / rest;
        folder = folder.parent_path();
    }
}

std::vector<FileKey> keys_of_file(const std::string& path, int standard) {
    std::vector<FileKey> keys;
    if (path.empty()) return keys;
    const auto status = path == "-" ? status_of_open(standard) : status_of(path);
    // Not every system knows which file was redirected to a stream.
    if (status && status->is_regular() && status->inode != 0) keys.push_back({status->device, status->inode});
    if (path == "-") return keys;
    keys.push_back(place_of_file(path));
    const std::string target = slashed(target_of_links(path));
    if (target != path) keys.push_back(place_of_file(target));
    return keys;
}

}  // namespace tex::cli
