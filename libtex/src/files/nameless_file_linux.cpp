// SPDX-License-Identifier: Apache-2.0

#include <fcntl.h>
#include <linux/fs.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>

#include "files/nameless_file.h"

namespace tex::inline v1 {

int folder_flags() { return O_PATH | O_DIRECTORY; }

Descriptor open_nameless(int folder, unsigned mode) {
    Descriptor file(::openat(folder, ".", O_TMPFILE | O_WRONLY | O_CLOEXEC, mode));
    if (!file) {
        if (errno == EOPNOTSUPP || errno == EISDIR || errno == EINVAL || errno == ENOENT) errno = ENOTSUP;
        return file;
    }
    // The file will get its name through /proc.
    if (faccessat(AT_FDCWD, path_of_open(file.get()).c_str(), F_OK, 0) == 0) return file;
    file.reset();
    errno = ENOTSUP;
    return file;
}

bool give_name(int fd, int folder, const std::string& name) {
    return linkat(AT_FDCWD, path_of_open(fd).c_str(), folder, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
}

std::string path_of_open(int fd) { return "/proc/self/fd/" + std::to_string(fd); }

bool rename_to_new(int folder, const char* from, const char* to) {
    if (renameat2(folder, from, folder, to, RENAME_NOREPLACE) == 0) return true;
    if (errno == EINVAL) errno = ENOSYS;
    return false;
}

Descriptor scratch_file(const std::string& folder) {
    Descriptor file(::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600));
    if (!file) file = Descriptor(memfd_create("scratch", MFD_CLOEXEC));
    return file;
}

Descriptor file_in_memory() {
    Descriptor file(memfd_create("libtex", MFD_CLOEXEC | MFD_ALLOW_SEALING));
    if (file && fcntl(file.get(), F_ADD_SEALS, F_SEAL_SHRINK) != 0) file.reset();
    return file;
}

void release_pages(int fd, std::uint64_t begin, std::uint64_t end, std::uint64_t kept) {
    const auto page = static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    const std::uint64_t first = std::max(begin / page, (kept + page - 1) / page) * page, last = end / page * page;
    if (last <= first) return;
    [[maybe_unused]] const int failed = fallocate(fd, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE,
                                                  static_cast<off_t>(first), static_cast<off_t>(last - first));
}

}  // namespace tex::inline v1
