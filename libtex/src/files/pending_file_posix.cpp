// SPDX-License-Identifier: Apache-2.0

#include "files/pending_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <optional>
#include <utility>

#include "files/atomic_file.h"
#include "files/file_rights.h"
#include "files/input_file.h"
#include "files/nameless_file.h"
#include "files/system_error.h"
#include "files/unfinished_files.h"

namespace tex::inline v1 {
namespace {

// Where the file goes, relative to its open directory.
struct Target {
    std::string path;  // as the caller gave it, for messages
    Descriptor folder;
    std::string name;
    std::optional<struct stat> existing;  // the file whose rights the new one takes over
};

Error exists_error(const Target& target) { return {ErrorCode::io, target.path, "exists already"}; }

// Follows the last component of `path` through symbolic links, even to a missing target. The link stays, and its target
// is written.
Result<std::string> follow_links(const std::string& path) {
    std::string at = path;
    constexpr int kMostLinks = 40;  // the kernel's limit
    for (int k = 0; k < kMostLinks; ++k) {
        char target[PATH_MAX];
        const ssize_t n = readlink(at.c_str(), target, sizeof target);
        if (n < 0) return at;  // not a link, or missing
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

Result<Target> find_target(const std::string& path, const AtomicFileOptions& options) {
    const Result<std::string> real = options.follow_links ? follow_links(path) : path;
    if (!real) return real.error();
    Target target;
    target.path = path;
    const std::string& full = real.value();
    const std::size_t slash = full.rfind('/');
    target.name = slash == std::string::npos ? full : full.substr(slash + 1);
    const std::string folder = slash == std::string::npos ? "." : full.substr(0, slash + 1);
    if (target.name.empty()) return Error{ErrorCode::io, path, "names a directory, not a file"};

    target.folder = Descriptor(::open(folder.c_str(), folder_flags() | O_DIRECTORY | O_CLOEXEC));
    if (!target.folder) {
        if (errno == ENOENT) return Error{ErrorCode::io, path, "the directory does not exist"};
        return system_error(path, errno);
    }
    struct stat status {};
    if (fstatat(target.folder.get(), target.name.c_str(), &status, AT_SYMLINK_NOFOLLOW) == 0) {
        if (options.no_clobber) return exists_error(target);
        if (S_ISDIR(status.st_mode)) return system_error(path, EISDIR);
        if (S_ISREG(status.st_mode)) target.existing = status;
    } else if (errno != ENOENT) {
        return system_error(path, errno);
    }
    return target;
}

// Returns 0 or an errno: EWOULDBLOCK if another process or descriptor holds the lock.
int lock(int fd) {
    int failed = -1;
    do {
        failed = flock(fd, LOCK_EX | LOCK_NB);
    } while (failed != 0 && errno == EINTR);
    return failed == 0 ? 0 : errno;
}

bool same_file(const Target& target, const std::string& name, int fd) {
    struct stat named {};
    struct stat open {};
    return fstatat(target.folder.get(), name.c_str(), &named, AT_SYMLINK_NOFOLLOW) == 0 && fstat(fd, &open) == 0 &&
           named.st_dev == open.st_dev && named.st_ino == open.st_ino;
}

// Removes the temporary file called `name` if its writer is gone.
void sweep(const Target& target, const std::string& name) {
    const Descriptor file(::openat(target.folder.get(), name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
    struct stat status {};
    if (!file || fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode)) return;
    if (lock(file.get()) == 0 && same_file(target, name, file.get())) unlinkat(target.folder.get(), name.c_str(), 0);
}

// Calls make(name) for temporary names until it succeeds. Removes files that dead writers left under these names.
// Returns the name, or an empty string and errno.
template <class Make>
std::string temporary_name(const Target& target, const Make& make) {
    constexpr std::size_t kMostOfName = 200;  // of the 255 bytes that a name may have
    constexpr int kMostWriters = 4096;
    std::string stem(1, '.');
    stem.append(target.name, 0, kMostOfName).append(".tex-tmp");
    for (int k = 0; k < kMostWriters; ++k) {
        std::string name = stem + std::to_string(k);
        if (make(name)) return name;
        if (errno != EEXIST) return {};
        sweep(target, name);
        if (make(name)) return name;
        if (errno != EEXIST) return {};
    }
    errno = EEXIST;
    return {};
}

// Renames a temporary file to the target; if this fails, removes the file. Returns 0 or an errno. The section must also
// cover all that the caller does with the temporary name.
int move_into_place(const NameSection&, const Target& target, const std::string& temporary, bool no_clobber) {
    const int folder = target.folder.get();
    const char* from = temporary.c_str();
    const char* to = target.name.c_str();
    int failed = 0;
    if (!no_clobber) {
        failed = renameat(folder, from, folder, to);
    } else {
        failed = rename_to_new(folder, from, to) ? 0 : -1;
        if (failed != 0 && errno == ENOSYS) {
            failed = linkat(folder, from, folder, to, 0);
            if (failed == 0) unlinkat(folder, from, 0);
        }
    }
    if (failed == 0) return 0;
    const int reason = errno;
    unlinkat(folder, from, 0);
    return reason;
}

// `failed` is what move_into_place() returned.
Result<void> moved(const Target& target, int failed, bool no_clobber) {
    if (failed == 0) return {};
    if (no_clobber && failed == EEXIST) return exists_error(target);
    return system_error(target.path, failed, "cannot be put into place");
}

// The mode of a new file: the umask decides. A replacement is private until keep_rights().
mode_t first_mode(const Target& target) { return target.existing ? 0600 : 0666; }

// Opens a file without a name; returns an empty descriptor if nameless files are not possible here. Errors: io.
Result<Descriptor> open_without_name(const Target& target) {
    Descriptor file = open_nameless(target.folder.get(), first_mode(target));
    if (file) {
        lock(file.get());
        return file;
    }
    if (errno == ENOTSUP) return Descriptor();
    return system_error(target.path, errno, "the directory cannot be written");
}

// Opens a file with a temporary name and stores the name in `name` and `unfinished`. Errors: io.
Result<Descriptor> open_named(const Target& target, std::string& name, UnfinishedFile& unfinished) {
    Descriptor file;
    name = temporary_name(target, [&](const std::string& temporary) {
        const NameSection section;
        file = Descriptor(::openat(target.folder.get(), temporary.c_str(),
                                   O_CREAT | O_EXCL | O_WRONLY | O_NOFOLLOW | O_CLOEXEC, first_mode(target)));
        if (!file) return false;
        // Before the file is locked, another process may take it for a dead writer's file. It has then been removed, or
        // will be soon.
        if (lock(file.get()) == EWOULDBLOCK || !same_file(target, temporary, file.get())) {
            errno = EEXIST;
            return false;
        }
        unfinished.add(section, target.folder.get(), temporary);
        return true;
    });
    if (name.empty()) return system_error(target.path, errno, "the directory cannot be written");
    return file;
}

Result<void> link_nameless(int fd, const Target& target, bool no_clobber) {
    const auto link = [&](const std::string& name) { return give_name(fd, target.folder.get(), name); };
    if (!target.existing || no_clobber) {
        if (link(target.name)) return {};
        if (errno != EEXIST) return system_error(target.path, errno, "cannot be put into place");
        if (no_clobber) return exists_error(target);
    }
    int failed = 0;
    const std::string temporary = temporary_name(target, [&](const std::string& name) {
        const NameSection section;
        if (!link(name)) return false;
        failed = move_into_place(section, target, name, no_clobber);
        return true;
    });
    if (temporary.empty()) return system_error(target.path, errno, "the directory cannot be written");
    return moved(target, failed, no_clobber);
}

}  // namespace

struct PendingFile::State {
    Target target;
    Descriptor file;
    std::string temporary;                     // the name of the temporary file, if it has one
    std::optional<UnfinishedFile> unfinished;  // the same for remove_unfinished_files()

    ~State() {
        if (temporary.empty()) return;
        const NameSection section;
        unfinished->remove(section);
        unlinkat(target.folder.get(), temporary.c_str(), 0);
    }
};

PendingFile::PendingFile(std::unique_ptr<State> state) : state_(std::move(state)) {}
PendingFile::PendingFile(PendingFile&&) noexcept = default;
PendingFile::~PendingFile() = default;

Result<PendingFile> PendingFile::open(const std::string& path, const AtomicFileOptions& options) {
    Result<Target> target = find_target(path, options);
    if (!target) return target.error();
    // A rename would replace a file that its owner has protected. A user who may not write the file may not replace it.
    if (target->existing && faccessat(target->folder.get(), target->name.c_str(), W_OK, AT_EACCESS) != 0)
        return system_error(path, errno);
    auto state = std::make_unique<State>();
    state->target = std::move(*target);
    Result<Descriptor> file = open_without_name(state->target);
    if (file && !*file) file = open_named(state->target, state->temporary, state->unfinished.emplace());
    if (!file) return file.error();
    state->file = std::move(*file);
    return PendingFile(std::move(state));
}

int PendingFile::descriptor() const { return state_->file.get(); }

Result<void> PendingFile::settle(bool sync) {
    const Target& target = state_->target;
    const int fd = descriptor();
    if (target.existing) keep_rights(fd, target.folder.get(), target.name, *target.existing);
    while (sync && fdatasync(fd) != 0) {
        if (errno == EINVAL) break;  // files of this type cannot be synchronised
        if (errno != EINTR) return system_error(target.path, errno, "cannot be written");
    }
    return {};
}

std::string PendingFile::complete_path() const { return path_of_open(descriptor()); }

Result<void> PendingFile::put_into_place(bool no_clobber) {
    const Target& target = state_->target;
    if (state_->temporary.empty()) return link_nameless(descriptor(), target, no_clobber);
    const std::string temporary = std::exchange(state_->temporary, {});
    int failed = 0;
    {
        const NameSection section;
        state_->unfinished->remove(section);
        failed = move_into_place(section, target, temporary, no_clobber);
    }
    return moved(target, failed, no_clobber);
}

}  // namespace tex::inline v1
