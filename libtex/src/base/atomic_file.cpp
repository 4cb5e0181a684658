// SPDX-License-Identifier: Apache-2.0

#include "base/atomic_file.h"

#include <fcntl.h>
#include <linux/fs.h>
#include <pthread.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <climits>
#include <cstdio>
#include <optional>
#include <string_view>

#include <tex/container.h>

#include "base/guard.h"
#include "base/input_file.h"
#include "base/system_error.h"

namespace tex {
namespace {

// 0, or the errno of what failed.
int write_fully(int fd, std::span<const std::byte> bytes) {
    constexpr std::size_t kMostAtOnce = std::size_t{1} << 30;
    while (!bytes.empty()) {
        const ssize_t n = ::write(fd, bytes.data(), std::min(bytes.size(), kMostAtOnce));
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return errno;
        bytes = bytes.subspan(static_cast<std::size_t>(n));
    }
    return 0;
}

// -- written through: standard output, FIFOs, devices --------------------------------------------------------

// While it lives, a pipe without a reader is an error (EPIPE) for this thread, not a signal that ends the process.
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

// The descriptor that "-", /dev/stdout, /dev/fd/N and /proc/self/fd/N stand for. They are written through even where a
// file is behind them: the shell that opened it holds on to that file.
std::optional<int> named_descriptor(std::string_view path) {
    if (path == "-" || path == "/dev/stdout") return STDOUT_FILENO;
    for (const std::string_view folder : {"/dev/fd/", "/proc/self/fd/"}) {
        if (!path.starts_with(folder)) continue;
        path.remove_prefix(folder.size());
        int fd = -1;
        const auto [end, error] = std::from_chars(path.data(), path.data() + path.size(), fd);
        if (error == std::errc() && end == path.data() + path.size()) return fd;
        return std::nullopt;
    }
    return std::nullopt;
}

Result<void> write_through(const std::string& path, int fd, std::span<const std::byte> bytes) {
    const NoPipeSignal no_signal;
    const int failed = write_fully(fd, bytes);
    if (failed != 0) return system_error(path, failed, "cannot be written");
    return {};
}

// -- replaced at once ----------------------------------------------------------------------------------------

// Where the file shall be, as seen from its open directory.
struct Target {
    std::string path;  // as the caller gave it, for messages
    Descriptor folder;
    std::string name;
    std::optional<struct stat> existing;
};

// Follows the last component of `path` through symbolic links, dangling ones too: the link stays, its target is written.
Result<std::string> follow_links(const std::string& path) {
    std::string at = path;
    constexpr int kMostLinks = 40;  // as the kernel
    for (int k = 0; k < kMostLinks; ++k) {
        char target[PATH_MAX];
        const ssize_t n = readlink(at.c_str(), target, sizeof target);
        if (n < 0) return at;  // no link, or not there at all
        const std::string_view to(target, static_cast<std::size_t>(n));
        const std::size_t slash = at.rfind('/');
        if (to.starts_with('/') || slash == std::string::npos) {
            at = to;
        } else {
            at = at.substr(0, slash + 1).append(to);
        }
    }
    return system_error(path, ELOOP);
}

Result<Target> find_target(const std::string& path) {
    const Result<std::string> real = follow_links(path);
    if (!real) return real.error();
    Target target;
    target.path = path;
    const std::string& full = real.value();
    const std::size_t slash = full.rfind('/');
    target.name = slash == std::string::npos ? full : full.substr(slash + 1);
    const std::string folder = slash == std::string::npos ? "." : full.substr(0, slash + 1);
    if (target.name.empty()) return Error{ErrorCode::io, path, "names a directory, not a file"};

    target.folder = Descriptor(::open(folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
    if (!target.folder) {
        if (errno == ENOENT) return Error{ErrorCode::io, path, "the directory does not exist"};
        return system_error(path, errno);
    }
    struct stat status {};
    if (fstatat(target.folder.get(), target.name.c_str(), &status, AT_SYMLINK_NOFOLLOW) == 0) {
        target.existing = status;
    } else if (errno != ENOENT) {
        return system_error(path, errno);
    }
    return target;
}

// Gives the new file the owner, group and mode of the old one, as far as this user may; never more rights to anybody.
void keep_rights(int fd, const struct stat& old) {
    mode_t mode = old.st_mode & 07777;
    struct stat now {};
    if (fstat(fd, &now) != 0) return;
    const bool owner_kept = now.st_uid == old.st_uid || fchown(fd, old.st_uid, static_cast<gid_t>(-1)) == 0;
    const bool group_kept = now.st_gid == old.st_gid || fchown(fd, static_cast<uid_t>(-1), old.st_gid) == 0;
    if (!owner_kept) mode &= ~static_cast<mode_t>(S_ISUID);
    if (!group_kept) mode = (mode & ~static_cast<mode_t>(S_ISGID | S_IRWXG)) | (mode & S_IRWXO) << 3;
    if (fchmod(fd, mode) != 0) return;  // the file stays readable by its writer alone
}

// Fills and locks a new file. 0, or the errno of what failed.
int fill(int fd, const Target& target, std::span<const std::byte> bytes, bool sync) {
    if (const int failed = write_fully(fd, bytes); failed != 0) return failed;
    if (target.existing) keep_rights(fd, *target.existing);
    while (sync && fdatasync(fd) != 0) {
        if (errno == EINVAL) break;  // this kind of file cannot be synchronised
        if (errno != EINTR) return errno;
    }
    return 0;
}

bool lock(int fd) {
    int failed = -1;
    do {
        failed = flock(fd, LOCK_EX | LOCK_NB);
    } while (failed != 0 && errno == EINTR);
    return failed == 0;
}

bool same_file(const Target& target, const std::string& name, int fd) {
    struct stat named {};
    struct stat open {};
    return fstatat(target.folder.get(), name.c_str(), &named, AT_SYMLINK_NOFOLLOW) == 0 && fstat(fd, &open) == 0 &&
           named.st_dev == open.st_dev && named.st_ino == open.st_ino;
}

// Removes the temporary called `name` if its writer is gone.
void sweep(const Target& target, const std::string& name) {
    const Descriptor file(::openat(target.folder.get(), name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
    struct stat status {};
    if (!file || fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode)) return;
    if (lock(file.get()) && same_file(target, name, file.get())) unlinkat(target.folder.get(), name.c_str(), 0);
}

// Calls make(name) for temporary names until it succeeds; sweeps what dead writers left under them. Returns the
// name, or an empty string and errno.
template <class Make>
std::string temporary_name(const Target& target, const Make& make) {
    constexpr std::size_t kMostOfName = 200;  // of 255 bytes that a name may have
    constexpr int kMostWriters = 4096;
    std::string stem(1, '.');
    stem.append(target.name, 0, kMostOfName).append(".tex-tmp");
    for (int k = 0; k < kMostWriters; ++k) {
        const std::string name = stem + std::to_string(k);
        if (make(name)) return name;
        if (errno != EEXIST) return {};
        sweep(target, name);
        if (make(name)) return name;
        if (errno != EEXIST) return {};
    }
    errno = EEXIST;
    return {};
}

Error exists_error(const Target& target) { return {ErrorCode::io, target.path, "exists already"}; }

// Renames a temporary to the target; on failure it is removed.
Result<void> move_into_place(const Target& target, const std::string& temporary, bool no_clobber) {
    const int folder = target.folder.get();
    const char* from = temporary.c_str();
    const char* to = target.name.c_str();
    int failed = 0;
    if (!no_clobber) {
        failed = renameat(folder, from, folder, to);
    } else {
        failed = renameat2(folder, from, folder, to, RENAME_NOREPLACE);
        if (failed != 0 && (errno == EINVAL || errno == ENOSYS)) {
            failed = linkat(folder, from, folder, to, 0);
            if (failed == 0) unlinkat(folder, from, 0);
        }
    }
    if (failed == 0) return {};
    const int reason = errno;
    unlinkat(folder, from, 0);
    if (no_clobber && reason == EEXIST) return exists_error(target);
    return system_error(target.path, reason, "cannot be put into place");
}

bool link_nameless(int fd, const Target& target, const std::string& name) {
    const std::string path = "/proc/self/fd/" + std::to_string(fd);
    return linkat(AT_FDCWD, path.c_str(), target.folder.get(), name.c_str(), AT_SYMLINK_FOLLOW) == 0;
}

// The mode of a new file: the umask decides; a replacement is private until keep_rights().
mode_t first_mode(const Target& target) { return target.existing ? 0600 : 0666; }

// Nullopt where there are no nameless files here.
std::optional<Result<void>> write_nameless(const Target& target, std::span<const std::byte> bytes,
                                           const AtomicFileOptions& options) {
    const Descriptor file(
        ::openat(target.folder.get(), ".", O_TMPFILE | O_WRONLY | O_CLOEXEC, first_mode(target)));
    if (!file) {
        const bool unsupported = errno == EOPNOTSUPP || errno == EISDIR || errno == EINVAL || errno == ENOENT;
        if (unsupported) return std::nullopt;
        return system_error(target.path, errno, "the directory cannot be written");
    }
    lock(file.get());
    if (const int failed = fill(file.get(), target, bytes, options.sync); failed != 0) {
        return system_error(target.path, failed, "cannot be written");
    }
    if (!target.existing || options.no_clobber) {
        if (link_nameless(file.get(), target, target.name)) return Result<void>();
        if (errno == ENOENT) return std::nullopt;  // no /proc
        if (errno != EEXIST) return system_error(target.path, errno, "cannot be put into place");
        if (options.no_clobber) return exists_error(target);
    }
    const std::string temporary = temporary_name(
        target, [&](const std::string& name) { return link_nameless(file.get(), target, name); });
    if (temporary.empty()) {
        if (errno == ENOENT) return std::nullopt;
        return system_error(target.path, errno, "the directory cannot be written");
    }
    return move_into_place(target, temporary, options.no_clobber);
}

Result<void> write_named(const Target& target, std::span<const std::byte> bytes, const AtomicFileOptions& options) {
    Descriptor file;
    const std::string temporary = temporary_name(target, [&](const std::string& name) {
        file = Descriptor(::openat(target.folder.get(), name.c_str(),
                                   O_CREAT | O_EXCL | O_WRONLY | O_NOFOLLOW | O_CLOEXEC, first_mode(target)));
        if (!file) return false;
        lock(file.get());
        if (same_file(target, name, file.get())) return true;
        errno = EEXIST;  // somebody took it for a dead writer's before it was locked
        return false;
    });
    if (temporary.empty()) return system_error(target.path, errno, "the directory cannot be written");
    if (const int failed = fill(file.get(), target, bytes, options.sync); failed != 0) {
        unlinkat(target.folder.get(), temporary.c_str(), 0);
        return system_error(target.path, failed, "cannot be written");
    }
    return move_into_place(target, temporary, options.no_clobber);
}

}  // namespace

Result<void> write_atomically(const std::string& path, std::span<const std::byte> bytes,
                              const AtomicFileOptions& options) {
    return guarded([&]() -> Result<void> {
        if (path.find('\0') != std::string::npos) return Error{ErrorCode::io, path, "the name holds a zero byte"};
        if (const std::optional<int> fd = named_descriptor(path)) return write_through(path, *fd, bytes);
        struct stat status {};
        if (stat(path.c_str(), &status) == 0) {
            if (S_ISDIR(status.st_mode)) return system_error(path, EISDIR);
            if (!S_ISREG(status.st_mode)) {
                const Descriptor device(::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY));
                if (!device) return system_error(path, errno);
                return write_through(path, device.get(), bytes);
            }
        }
        const Result<Target> target = find_target(path);
        if (!target) return target.error();
        if (target->existing && options.no_clobber) return exists_error(*target);
        // A rename would replace a file that its owner has protected; who may not write it shall not.
        if (target->existing && faccessat(target->folder.get(), target->name.c_str(), W_OK, AT_EACCESS) != 0) {
            return system_error(path, errno);
        }
        if (std::optional<Result<void>> done = write_nameless(*target, bytes, options)) return std::move(*done);
        return write_named(*target, bytes, options);
    });
}

Result<void> write_file(const std::string& path, const std::vector<std::byte>& bytes, const WriteOptions& options) {
    return write_atomically(path, bytes, {options.sync, options.no_clobber});
}

}  // namespace tex
