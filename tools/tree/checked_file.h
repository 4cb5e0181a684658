// SPDX-License-Identifier: Apache-2.0
// checked_file.h: the file that a texture is in while it is checked.

#pragma once

#include <string>

namespace tex::cli {

// On Linux, the file has no name and is in memory, so that nothing of it is left, however the run ends. Elsewhere, it
// is in the folder for temporary files.
class CheckedFile {
public:
    CheckedFile();
    CheckedFile(const CheckedFile&) = delete;
    CheckedFile& operator=(const CheckedFile&) = delete;
    ~CheckedFile();
    [[nodiscard]] bool is_open() const { return !path_.empty(); }  // if not, errno says why
    [[nodiscard]] const std::string& path() const { return path_; }

private:
    int fd_ = -1;
    std::string path_;
};

}  // namespace tex::cli
