// SPDX-License-Identifier: Apache-2.0

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "files/system_error.h"
#include "files/through_file.h"

namespace tex::inline v1 {

Result<std::optional<ThroughFile>> ThroughFile::open(const std::string& path) {
    if (const std::optional<int> fd = named_descriptor(path))
        return std::optional(ThroughFile(path, Descriptor(), *fd));
    const std::optional<FileStatus> status = FileStatus::of(path);
    if (!status || status->kind == FileKind::regular) return std::optional<ThroughFile>();
    if (status->kind == FileKind::folder) return system_error(path, EISDIR);
    Descriptor device(::open(path.c_str(), O_WRONLY));
    if (!device) return system_error(path, errno);
    const int fd = device.get();
    return std::optional(ThroughFile(path, std::move(device), fd));
}

Result<void> ThroughFile::write(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t n = ::write(fd_, bytes.data(), bytes.size());
        if (n <= 0) return system_error(path_, n < 0 ? errno : EIO, "cannot be written");
        bytes = bytes.subspan(static_cast<std::size_t>(n));
    }
    return {};
}

}  // namespace tex::inline v1
