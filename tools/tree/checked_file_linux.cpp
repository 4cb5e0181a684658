// SPDX-License-Identifier: Apache-2.0

#include "tree/checked_file.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

namespace tex::cli {

CheckedFile::CheckedFile() : fd_(memfd_create("texture", MFD_CLOEXEC)) {
    if (fd_ >= 0) path_ = fmt::format("/proc/self/fd/{}", fd_);
}

CheckedFile::~CheckedFile() {
    if (fd_ >= 0) close(fd_);
}

}  // namespace tex::cli
