// SPDX-License-Identifier: Apache-2.0
// Through open folders, so that nobody can put a link on the way between the look at a file and its removal.

#include "tree/removal.h"

#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <vector>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tree/opened_linux.h"

namespace tex::cli {
namespace {

Removal absence() { return errno == ENOENT ? Removal::missing : Removal::changed; }

bool has_sum(int fd, const Digest& digest) {
    Sha256 sum;
    std::vector<char> buffer(std::size_t{1} << 18);
    while (true) {
        const ssize_t count = read(fd, buffer.data(), buffer.size());
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return false;
        if (count == 0) return sum.finish() == digest;
        sum.add(buffer.data(), static_cast<std::size_t>(count));
    }
}

}  // namespace

Removal remove_output(const std::string& folder, const std::string& name, const Digest& digest, bool is_dry_run) {
    constexpr int kFlags = O_RDONLY | O_CLOEXEC;
    Opened at(open(folder.empty() ? "." : folder.c_str(), kFlags | O_DIRECTORY));
    const std::filesystem::path path(name);
    for (const std::filesystem::path& part : path.parent_path()) {
        if (at) at.become(openat(at.get(), part.c_str(), kFlags | O_DIRECTORY | O_NOFOLLOW));
    }
    if (!at) return absence();
    const std::string last = path.filename();
    // O_NONBLOCK: a FIFO must not keep us waiting.
    const Opened file(openat(at.get(), last.c_str(), kFlags | O_NOFOLLOW | O_NONBLOCK));
    if (!file) return absence();
    struct stat status {};
    if (fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode) || !has_sum(file.get(), digest))
        return Removal::changed;
    if (is_dry_run || unlinkat(at.get(), last.c_str(), 0) == 0) return Removal::removed;
    return Removal::failed;
}

}  // namespace tex::cli
