// SPDX-License-Identifier: Apache-2.0

#include "tree/checked_file.h"

#include <cerrno>
#include <filesystem>
#include <random>
#include <system_error>

#include <fmt/format.h>

#include "cli/file_status.h"
#include "files/path_names.h"

namespace tex::cli {

CheckedFile::CheckedFile() {
    std::error_code error;
    const std::filesystem::path folder = std::filesystem::temp_directory_path(error);
    std::random_device random;
    constexpr int kTries = 100;
    for (int k = 0; k < kTries && !error; ++k) {
        path_ = slashed(folder / fmt::format("tex-checked-{:08x}{:08x}", random(), random()));
        if (!status_of_link(path_)) return;
    }
    path_.clear();
    errno = error ? error.value() : EEXIST;
}

CheckedFile::~CheckedFile() {
    if (is_open()) remove_file(path_);
}

}  // namespace tex::cli
