// SPDX-License-Identifier: Apache-2.0
// WebAssembly has no locks, rights or files without names: the file is written under a temporary name beside the
// target, and renamed. Whoever implements the rename gives the file the rights of the one that it replaces.

#include "files/pending_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <cstdio>
#include <string>
#include <utility>

#include "files/atomic_file.h"
#include "files/descriptor.h"
#include "files/system_error.h"

namespace tex::inline v1 {
namespace {

// Follows the last component of `path` through symbolic links, even to a missing target. The link stays, and its target
// is written.
Result<std::string> follow_links(const std::string& path) {
    std::string at = path;
    constexpr int kMostLinks = 40;  // Linux's limit
    for (int k = 0; k < kMostLinks; ++k) {
        char target[PATH_MAX];
        const ssize_t n = readlink(at.c_str(), target, sizeof target);
        if (n < 0) return at;  // not a link, or missing
        const std::string to(target, static_cast<std::size_t>(n));
        const std::size_t slash = at.rfind('/');
        at = to.starts_with('/') || slash == std::string::npos ? to : at.substr(0, slash + 1) + to;
    }
    return system_error(path, ELOOP);
}

}  // namespace

struct PendingFile::State {
    std::string path;    // as the caller gave it, for messages
    std::string target;  // where it goes
    std::string temporary;
    Descriptor file;
};

Result<PendingFile> PendingFile::open(const std::string& path, const AtomicFileOptions& options) {
    const Result<std::string> target = options.follow_links ? follow_links(path) : path;
    if (!target) return target.error();
    const std::size_t name = target->rfind('/') + 1;  // 0 without a slash
    if (name == target->size()) return Error{ErrorCode::io, path, "names a directory, not a file"};
    struct stat existing {};
    if (lstat(target->c_str(), &existing) == 0) {
        if (options.no_clobber) return Error{ErrorCode::io, path, "exists already"};
        if (S_ISDIR(existing.st_mode)) return system_error(path, EISDIR);
        // A rename would replace a file that its owner has protected.
        if (S_ISREG(existing.st_mode) && !Descriptor(::open(target->c_str(), O_WRONLY)))
            return system_error(path, errno);
    } else if (errno != ENOENT) {
        return system_error(path, errno);
    }
    auto state = std::make_unique<State>();
    state->path = path;
    state->target = *target;
    constexpr std::size_t kMostOfName = 200;  // of the 255 bytes that a name may have
    constexpr int kMostWriters = 4096;
    const std::string stem = target->substr(0, name) + "." + target->substr(name, kMostOfName) + ".tex-tmp";
    for (int k = 0; k < kMostWriters && !state->file; ++k) {
        const std::string temporary = stem + std::to_string(k);
        state->file = Descriptor(::open(temporary.c_str(), O_RDWR | O_CREAT | O_EXCL, 0666));
        if (state->file) state->temporary = temporary;
        if (!state->file && errno != EEXIST) break;
    }
    if (!state->file && errno == ENOENT) return Error{ErrorCode::io, path, "the directory does not exist"};
    if (!state->file && (errno == ENOTDIR || errno == ELOOP)) return system_error(path, errno);
    if (!state->file) return system_error(path, errno, "the directory cannot be written");
    return PendingFile(std::move(state));
}

PendingFile::PendingFile(std::unique_ptr<State> state) : state_(std::move(state)) {}
PendingFile::PendingFile(PendingFile&& other) noexcept = default;

PendingFile::~PendingFile() {
    if (state_ && !state_->temporary.empty()) unlink(state_->temporary.c_str());
}

int PendingFile::descriptor() const { return state_->file.get(); }

Result<void> PendingFile::settle(bool sync) {
    if (sync && fdatasync(state_->file.get()) != 0 && errno != EINVAL && errno != ENOTSUP)
        return system_error(state_->path, errno, "cannot be written");
    return {};
}

std::string PendingFile::complete_path() const { return state_->temporary; }

Result<void> PendingFile::put_into_place(bool no_clobber) {
    if (no_clobber) {
        struct stat existing {};
        if (lstat(state_->target.c_str(), &existing) == 0) return Error{ErrorCode::io, state_->path, "exists already"};
    }
    if (std::rename(state_->temporary.c_str(), state_->target.c_str()) != 0)
        return system_error(state_->path, errno, "cannot be put into place");
    state_->temporary.clear();
    return {};
}

}  // namespace tex::inline v1
