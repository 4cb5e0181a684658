// SPDX-License-Identifier: Apache-2.0

#include "files/through_file.h"

#include <utility>

namespace tex::inline v1 {

ThroughFile::ThroughFile(std::string path, Descriptor owned, int fd)
    : path_(std::move(path)), owned_(std::move(owned)), fd_(fd), mutex_(std::make_unique<std::mutex>()) {}

void ThroughFile::hold(std::uint64_t offset, std::span<const std::byte> bytes) {
    const std::lock_guard lock(*mutex_);
    held_.emplace(offset, std::vector<std::byte>(bytes.begin(), bytes.end()));
}

Result<void> ThroughFile::write_held() {
    const std::lock_guard lock(*mutex_);
    std::uint64_t position = 0;
    for (auto& [offset, bytes] : held_) {
        const std::vector<std::byte> gap(static_cast<std::size_t>(offset - position));
        if (Result<void> written = write(gap); !written) return written;
        if (Result<void> written = write(bytes); !written) return written;
        position = offset + bytes.size();
    }
    held_.clear();
    return {};
}

}  // namespace tex::inline v1
