// SPDX-License-Identifier: Apache-2.0

#include "files/output_file.h"

#include <algorithm>
#include <utility>

#include "files/descriptor.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

// A file of at most this size in bytes is assembled in memory and written at once: one system call for each level takes
// as long as the level itself.
constexpr std::size_t kWrittenAtOnce = std::size_t{1} << 18;

// Whether `path` is a FIFO or a device, whose bytes AtomicFile holds in memory anyway.
bool is_written_through(const std::string& path) {
    const std::optional<FileStatus> status = FileStatus::of(path);
    return status && status->kind != FileKind::regular && status->kind != FileKind::folder;
}

}  // namespace

Result<std::unique_ptr<OutputFile>> OutputFile::open(const std::string& path, std::size_t bytes, Opened when,
                                                     const AtomicFileOptions& options) {
    return no_throw([&]() -> Result<std::unique_ptr<OutputFile>> {
        std::unique_ptr<OutputFile> output(new OutputFile(path, options));
        const bool late = when == Opened::late && is_written_through(path);
        output->holds_ = bytes <= kWrittenAtOnce || late;
        if (bytes <= kWrittenAtOnce) output->held_.reserve(bytes);
        if (!output->holds_ || when == Opened::at_once) {
            Result<AtomicFile> file = AtomicFile::open(path, options);
            if (!file) return file.error();
            output->file_.emplace(std::move(*file));
        }
        return output;
    });
}

Result<void> OutputFile::write_at(std::uint64_t offset, std::span<const std::byte> bytes) {
    if (!holds_) return file_->write_at(offset, bytes);
    return no_throw([&]() -> Result<void> {
        const auto at = static_cast<std::size_t>(offset);
        const std::lock_guard lock(mutex_);
        held_.resize(std::max(held_.size(), at + bytes.size()));
        std::copy(bytes.begin(), bytes.end(), held_.begin() + static_cast<std::ptrdiff_t>(at));
        return {};
    });
}

Result<void> OutputFile::commit() {
    if (!file_) {
        Result<AtomicFile> file = AtomicFile::open(path_, options_);
        if (!file) return file.error();
        file_.emplace(std::move(*file));
    }
    if (!held_.empty()) {
        if (Result<void> written = file_->write_at(0, held_); !written) return written;
    }
    return file_->commit();
}

}  // namespace tex::inline v1
