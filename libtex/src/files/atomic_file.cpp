// SPDX-License-Identifier: Apache-2.0

#include "files/atomic_file.h"

#include <algorithm>
#include <cerrno>
#include <mutex>
#include <optional>
#include <utility>

#include <tex/file.h>

#include "files/descriptor.h"
#include "files/pending_file.h"
#include "files/system_error.h"
#include "files/through_file.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {

AtomicFileOptions AtomicFileOptions::of(const WriteOptions& options) {
    return {options.sync,     options.no_clobber, options.follow_links, options.before_replacing,
            options.replaced, options.into};
}

struct AtomicFile::State {
    std::string path;  // as the caller gave it
    AtomicFileOptions options;
    std::optional<PendingFile> pending = {};
    std::optional<ThroughFile> through = {};  // if set, there is no pending file
    std::mutex mutex = {};                    // guards the bytes of options.into, which there are instead of both
};

AtomicFile::AtomicFile(std::unique_ptr<State> state) : state_(std::move(state)) {}
AtomicFile::AtomicFile(AtomicFile&&) noexcept = default;
AtomicFile::~AtomicFile() = default;

Result<AtomicFile> AtomicFile::open(const std::string& path, const AtomicFileOptions& options) {
    return no_throw([&]() -> Result<AtomicFile> {
        if (path.find('\0') != std::string::npos) return Error{ErrorCode::io, path, "the name holds a zero byte"};
        std::unique_ptr<State> state(new State{path, options});
        if (options.into) {
            options.into->clear();
            return AtomicFile(std::move(state));
        }
        if (options.follow_links || named_descriptor(path)) {
            Result<std::optional<ThroughFile>> through = ThroughFile::open(path);
            if (!through) return through.error();
            state->through = std::move(*through);
        }
        if (!state->through) {
            Result<PendingFile> pending = PendingFile::open(path, options);
            if (!pending) return pending.error();
            state->pending.emplace(std::move(*pending));
        }
        return AtomicFile(std::move(state));
    });
}

Result<void> AtomicFile::write_at(std::uint64_t offset, std::span<const std::byte> bytes) {
    return no_throw([&]() -> Result<void> {
        if (state_->options.into) {
            const std::lock_guard lock(state_->mutex);
            std::vector<std::byte>& into = *state_->options.into;
            into.resize(std::max(into.size(), static_cast<std::size_t>(offset) + bytes.size()));
            std::copy(bytes.begin(), bytes.end(), into.begin() + static_cast<std::ptrdiff_t>(offset));
            return {};
        }
        if (state_->through) {
            state_->through->hold(offset, bytes);
            return {};
        }
        while (!bytes.empty()) {
            const std::ptrdiff_t n = write_some_at(state_->pending->descriptor(), offset, bytes.data(), bytes.size());
            if (n < 0) return system_error(state_->path, errno, "cannot be written");
            bytes = bytes.subspan(static_cast<std::size_t>(n));
            offset += static_cast<std::uint64_t>(n);
        }
        return {};
    });
}

Result<void> AtomicFile::commit() {
    return no_throw([&]() -> Result<void> {
        if (state_->options.into) return {};
        if (state_->through) return state_->through->write_held();
        const AtomicFileOptions& options = state_->options;
        PendingFile& pending = *state_->pending;
        if (Result<void> settled = pending.settle(options.sync); !settled) return settled;
        if (options.before_replacing) {
            if (Result<void> accepted = options.before_replacing(state_->path, pending.complete_path()); !accepted)
                return accepted;
        }
        const Result<void> placed = pending.put_into_place(options.no_clobber);
        if (placed && options.replaced) options.replaced(state_->path);
        return placed;
    });
}

Result<void> write_atomically(const std::string& path, std::span<const std::byte> bytes,
                              const AtomicFileOptions& options) {
    Result<AtomicFile> file = AtomicFile::open(path, options);
    if (!file) return file.error();
    if (file->state_->through) return file->state_->through->write(bytes);
    if (Result<void> written = file->write_at(0, bytes); !written) return written;
    return file->commit();
}

}  // namespace tex::inline v1
