// SPDX-License-Identifier: Apache-2.0
// For systems without files that have no name.

#include <cerrno>
#include <utility>

#include "files/nameless_file.h"

namespace tex::inline v1 {

int folder_flags() { return 0; }

Descriptor open_nameless(int, unsigned) {
    errno = ENOTSUP;
    return Descriptor();
}

bool give_name(int, int, const std::string&) {
    errno = ENOTSUP;
    return false;
}

std::string path_of_open(int fd) { return "/dev/fd/" + std::to_string(fd); }

bool rename_to_new(int, const char*, const char*) {
    errno = ENOSYS;
    return false;
}

Descriptor scratch_file(const std::string& folder) {
    Descriptor file = temporary_file(folder);
    return file ? std::move(file) : temporary_file({});
}

Descriptor file_in_memory() { return temporary_file({}); }

void release_pages(int, std::uint64_t, std::uint64_t, std::uint64_t) {}

}  // namespace tex::inline v1
