// SPDX-License-Identifier: Apache-2.0

#include "files/through_file.h"

#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <ctime>
#include <utility>

#include "files/system_error.h"

namespace tex::inline v1 {
namespace {

// Returns 0 or an errno.
int write_fully(int fd, std::span<const std::byte> bytes) {
    constexpr std::size_t kMostWritten = std::size_t{1} << 30;
    while (!bytes.empty()) {
        const ssize_t n = ::write(fd, bytes.data(), std::min(bytes.size(), kMostWritten));
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return n < 0 ? errno : EIO;
        bytes = bytes.subspan(static_cast<std::size_t>(n));
    }
    return 0;
}

// While this object exists, a pipe without a reader causes an error (EPIPE) in this thread, not a signal that ends the
// process.
class NoPipeSignal {
public:
    NoPipeSignal() {
        sigemptyset(&pipe_);
        sigaddset(&pipe_, SIGPIPE);
        sigset_t pending;
        sigpending(&pending);
        was_pending_ = sigismember(&pending, SIGPIPE) == 1;
        pthread_sigmask(SIG_BLOCK, &pipe_, &before_);
    }
    ~NoPipeSignal() {
        const timespec at_once{};
        while (!was_pending_ && sigtimedwait(&pipe_, nullptr, &at_once) == -1 && errno == EINTR) {
        }
        pthread_sigmask(SIG_SETMASK, &before_, nullptr);
    }
    NoPipeSignal(const NoPipeSignal&) = delete;
    NoPipeSignal& operator=(const NoPipeSignal&) = delete;

private:
    sigset_t pipe_{};
    sigset_t before_{};
    bool was_pending_ = false;
};

}  // namespace

Result<std::optional<ThroughFile>> ThroughFile::open(const std::string& path) {
    if (const std::optional<int> fd = named_descriptor(path))
        return std::optional(ThroughFile(path, Descriptor(), *fd));
    struct stat status {};
    if (stat(path.c_str(), &status) != 0) return std::optional<ThroughFile>();
    if (S_ISDIR(status.st_mode)) return system_error(path, EISDIR);
    if (S_ISREG(status.st_mode)) return std::optional<ThroughFile>();
    Descriptor device(::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY));
    // For a FIFO, this call waits for a reader. A signal that arrives meanwhile is meant to end the wait.
    if (!device && errno == EINTR) return Error{ErrorCode::cancelled, path, "interrupted while waiting for a reader"};
    if (!device) return system_error(path, errno);
    const int fd = device.get();
    // It may have been replaced since it was looked at. A regular file is never written in place.
    if (fstat(fd, &status) != 0 || S_ISREG(status.st_mode))
        return Error{ErrorCode::io, path, "was replaced while it was opened"};
    return std::optional(ThroughFile(path, std::move(device), fd));
}

Result<void> ThroughFile::write(std::span<const std::byte> bytes) {
    const NoPipeSignal no_signal;
    if (const int failed = write_fully(fd_, bytes); failed != 0)
        return system_error(path_, failed, "cannot be written");
    return {};
}

}  // namespace tex::inline v1
