// SPDX-License-Identifier: Apache-2.0

#include <fcntl.h>
#include <io.h>
#include <windows.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "files/system_error.h"
#include "files/through_file.h"
#include "files/wide_windows.h"

namespace tex::inline v1 {

Result<std::optional<ThroughFile>> ThroughFile::open(const std::string& path) {
    if (const std::optional<int> fd = named_descriptor(path))
        return std::optional(ThroughFile(path, Descriptor(), *fd));
    if (const char* const refusal = refusal_of_name(path); refusal != nullptr)
        return Error{ErrorCode::io, path, refusal};
    const std::optional<FileStatus> status = FileStatus::of(path);
    if (!status || status->kind == FileKind::regular) return std::optional<ThroughFile>();
    if (status->kind == FileKind::folder) return system_error(path, EISDIR);
    HANDLE handle = CreateFileW(system_path(path).c_str(), GENERIC_WRITE, FILE_SHARE_READ | FILE_SHARE_WRITE, nullptr,
                                OPEN_EXISTING, FILE_ATTRIBUTE_NORMAL, nullptr);
    if (handle == INVALID_HANDLE_VALUE) return system_error(path, set_errno());
    Descriptor device(_open_osfhandle(reinterpret_cast<intptr_t>(handle), _O_WRONLY | _O_BINARY | _O_NOINHERIT));
    if (!device) {
        CloseHandle(handle);
        return system_error(path, EMFILE);
    }
    if (GetFileType(handle) == FILE_TYPE_DISK) return Error{ErrorCode::io, path, "was replaced while it was opened"};
    const int fd = device.get();
    return std::optional(ThroughFile(path, std::move(device), fd));
}

Result<void> ThroughFile::write(std::span<const std::byte> bytes) {
    constexpr std::size_t kMostWritten = std::size_t{1} << 24;
    while (!bytes.empty()) {
        const int n = _write(fd_, bytes.data(), static_cast<unsigned>(std::min(bytes.size(), kMostWritten)));
        // The C library reports a pipe without a reader as an invalid argument.
        if (n <= 0) return system_error(path_, n < 0 && errno != EINVAL ? errno : EPIPE, "cannot be written");
        bytes = bytes.subspan(static_cast<std::size_t>(n));
    }
    return {};
}

}  // namespace tex::inline v1
