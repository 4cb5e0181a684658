// SPDX-License-Identifier: Apache-2.0
// WebAssembly has no locks, rights or files without names: the file is written under a temporary name beside the
// target, and renamed.

#include "files/pending_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <string>
#include <utility>

#include "files/atomic_file.h"
#include "files/descriptor.h"
#include "files/system_error.h"

namespace tex::inline v1 {

struct PendingFile::State {
    std::string path, temporary;
    Descriptor file;
};

Result<PendingFile> PendingFile::open(const std::string& path, const AtomicFileOptions& options) {
    const std::optional<FileStatus> existing = FileStatus::of(path);
    if (existing && options.no_clobber) return Error{ErrorCode::io, path, "exists already"};
    if (existing && existing->kind == FileKind::folder) return system_error(path, EISDIR);
    auto state = std::make_unique<State>();
    state->path = path;
    const std::size_t name = path.rfind('/') + 1;  // 0 without a slash
    constexpr int kMostWriters = 4096;
    for (int k = 0; k < kMostWriters && !state->file; ++k) {
        state->temporary = path.substr(0, name) + "." + path.substr(name) + ".tex-tmp" + std::to_string(k);
        state->file = Descriptor(::open(state->temporary.c_str(), O_RDWR | O_CREAT | O_EXCL, 0666));
        if (!state->file && errno != EEXIST) break;
    }
    if (!state->file && errno == ENOENT) return Error{ErrorCode::io, path, "the directory does not exist"};
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
    if (no_clobber && FileStatus::of(state_->path)) return Error{ErrorCode::io, state_->path, "exists already"};
    if (std::rename(state_->temporary.c_str(), state_->path.c_str()) != 0)
        return system_error(state_->path, errno, "cannot be replaced");
    state_->temporary.clear();
    return {};
}

}  // namespace tex::inline v1
