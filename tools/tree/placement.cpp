// SPDX-License-Identifier: Apache-2.0

#include "tree/placement.h"

namespace tex::cli {

WriteOptions Placement::watched(WriteOptions write) {
    write.before_replacing = [this](const std::string& path, const std::string& complete) {
        return accept(path, complete);
    };
    write.replaced = [this](const std::string& path) { note(path); };
    return write;
}

Result<void> Placement::accept(const std::string& path, const std::string& complete) {
    if (!outputs_.contains(path))
        return Error{ErrorCode::io, path, "is not an output that the manifest names; nothing is replaced"};
    const std::lock_guard lock(mutex_);
    const Result<Digest> digest = digest_of_file(complete);
    if (!digest) return digest.error().of(path);
    complete_[path] = {*digest, FileStamp::of(complete)};
    if (!is_accepted_) {
        const Result<bool> unchanged = is_unchanged_();
        if (!unchanged) return unchanged.error();
        if (!*unchanged) {
            met_change_ = true;
            return Error{ErrorCode::io, path, "what it is made from has changed"};
        }
        is_accepted_ = true;
    }
    return files_.may_replace(path);
}

void Placement::note(const std::string& path) {
    const std::lock_guard lock(mutex_);
    PlacedFile file = complete_[path];
    // The times of a file change when it gets its name. Its inode tells it from one that another program has put there.
    const std::optional<FileStamp> now = FileStamp::of(path);
    const bool is_ours = now && file.stamp && now->device == file.stamp->device && now->inode == file.stamp->inode;
    file.stamp = is_ours ? now : std::nullopt;
    placed_[path] = file;
}

}  // namespace tex::cli
