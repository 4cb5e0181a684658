// SPDX-License-Identifier: Apache-2.0
// Descriptors are those of Microsoft's C library, whose handles the calls of Windows take.
//
// On Windows, a read at an offset moves the position of the file, so that the positions of files on a disk are kept
// here, and every read of them is one at an offset.

#include <fcntl.h>
#include <io.h>
#include <windows.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <utility>

#include "files/descriptor.h"
#include "files/wide_windows.h"

namespace tex::inline v1 {
namespace {

constexpr std::size_t kMostAtOnce = std::size_t{1} << 30;
constexpr DWORD kShared = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;

// By descriptor; the C library has no more. -1: a stream, or not opened here.
constexpr int kMostDescriptors = 8192;
struct Position {
    std::atomic<std::int64_t> at{-1};
};
Position positions[kMostDescriptors];

std::atomic<std::int64_t>* position_in_file(int fd) {
    if (fd < 0 || fd >= kMostDescriptors || positions[fd].at < 0) return nullptr;
    return &positions[fd].at;
}

HANDLE handle_of(int fd) { return reinterpret_cast<HANDLE>(_get_osfhandle(fd)); }

// Makes a descriptor of a handle, which it then owns.
Descriptor descriptor_from(HANDLE handle, int flags) {
    if (handle == INVALID_HANDLE_VALUE) {
        set_errno();
        return Descriptor();
    }
    Descriptor file(_open_osfhandle(reinterpret_cast<intptr_t>(handle), flags | _O_BINARY | _O_NOINHERIT));
    if (!file) {
        CloseHandle(handle);
        return file;
    }
    if (file.get() < kMostDescriptors && GetFileType(handle) == FILE_TYPE_DISK) positions[file.get()].at = 0;
    return file;
}

OVERLAPPED at_offset(std::uint64_t offset) {
    OVERLAPPED place{};
    place.Offset = static_cast<DWORD>(offset);
    place.OffsetHigh = static_cast<DWORD>(offset >> 32);
    return place;
}

std::optional<FileStatus> status_of_handle(HANDLE handle) {
    FileStatus status;
    const DWORD type = GetFileType(handle);
    if (type == FILE_TYPE_CHAR) status.kind = FileKind::device;
    if (type != FILE_TYPE_DISK) return status;
    FILE_STANDARD_INFO file{};
    FILE_BASIC_INFO times{};
    if (GetFileInformationByHandleEx(handle, FileStandardInfo, &file, sizeof file) == 0 ||
        GetFileInformationByHandleEx(handle, FileBasicInfo, &times, sizeof times) == 0) {
        set_errno();
        return std::nullopt;
    }
    BY_HANDLE_FILE_INFORMATION identity{};  // Wine has none of what was redirected to standard input
    GetFileInformationByHandle(handle, &identity);
    status.kind = file.Directory != FALSE ? FileKind::folder : FileKind::regular;
    status.version = {identity.dwVolumeSerialNumber,
                      std::uint64_t{identity.nFileIndexHigh} << 32 | identity.nFileIndexLow, file.EndOfFile.QuadPart,
                      nanoseconds_of(times.LastWriteTime.QuadPart), nanoseconds_of(times.ChangeTime.QuadPart)};
    return status;
}

}  // namespace

void Descriptor::reset() {
    if (fd_ >= 0) {
        if (fd_ < kMostDescriptors) positions[fd_].at = -1;
        _close(fd_);
    }
    fd_ = -1;
}

std::optional<FileStatus> FileStatus::of(const std::string& path) {
    const std::wstring full = system_path(path);
    if (full.empty()) return std::nullopt;
    HANDLE handle = CreateFileW(full.c_str(), FILE_READ_ATTRIBUTES, kShared, nullptr, OPEN_EXISTING,
                                FILE_FLAG_BACKUP_SEMANTICS, nullptr);
    if (handle == INVALID_HANDLE_VALUE) {
        set_errno();
        return std::nullopt;
    }
    const std::optional<FileStatus> status = status_of_handle(handle);
    CloseHandle(handle);
    return status;
}

std::optional<FileStatus> FileStatus::of(int fd) {
    HANDLE handle = handle_of(fd);
    if (handle == INVALID_HANDLE_VALUE) {
        errno = EBADF;
        return std::nullopt;
    }
    return status_of_handle(handle);
}

std::optional<FileVersion> FileVersion::of(const std::string& path) {
    const std::optional<FileStatus> status = FileStatus::of(path);
    if (!status || status->kind != FileKind::regular) return std::nullopt;
    return status->version;
}

Descriptor open_for_reading(const std::string& path) {
    if (path != "-") {
        const std::wstring full = system_path(path);
        if (full.empty()) return Descriptor();
        // With the flag for folders, these can be opened, and the caller says that they are folders.
        return descriptor_from(CreateFileW(full.c_str(), GENERIC_READ, kShared, nullptr, OPEN_EXISTING,
                                           FILE_FLAG_BACKUP_SEMANTICS, nullptr),
                               _O_RDONLY);
    }
    HANDLE copy = INVALID_HANDLE_VALUE;
    HANDLE input = handle_of(kStandardInput);
    HANDLE self = GetCurrentProcess();
    if (DuplicateHandle(self, input, self, &copy, 0, FALSE, DUPLICATE_SAME_ACCESS) == 0) copy = INVALID_HANDLE_VALUE;
    Descriptor file = descriptor_from(copy, _O_RDONLY);
    LARGE_INTEGER at{};
    if (file && position_in_file(file.get()) != nullptr && SetFilePointerEx(copy, {}, &at, FILE_CURRENT) != 0)
        set_position(file.get(), at.QuadPart);
    return file;
}

Descriptor temporary_file(const std::string& folder) {
    static std::atomic<unsigned> made{0};
    std::wstring where = folder.empty() ? std::wstring() : system_path(folder);
    if (where.empty()) {
        where.resize(MAX_PATH + 1);
        where.resize(GetTempPathW(MAX_PATH + 1, where.data()));
    }
    if (!where.ends_with(L'\\')) where += L'\\';
    LARGE_INTEGER now{};
    QueryPerformanceCounter(&now);
    const std::wstring name = where + L".tex-tmp-" + std::to_wstring(GetCurrentProcessId()) + L"-" +
                              std::to_wstring(now.QuadPart) + L"-" + std::to_wstring(made++);
    return descriptor_from(
        CreateFileW(name.c_str(), GENERIC_READ | GENERIC_WRITE, FILE_SHARE_DELETE, nullptr, CREATE_NEW,
                    FILE_ATTRIBUTE_TEMPORARY | FILE_ATTRIBUTE_HIDDEN | FILE_FLAG_DELETE_ON_CLOSE, nullptr),
        _O_RDWR);
}

std::ptrdiff_t read_some(int fd, std::byte* to, std::size_t count) {
    std::atomic<std::int64_t>* const position = position_in_file(fd);
    if (position == nullptr) return _read(fd, to, static_cast<unsigned>(std::min(count, kMostAtOnce)));
    const std::ptrdiff_t got = read_some_at(fd, static_cast<std::uint64_t>(position->load()), to, count);
    if (got > 0) *position += got;
    return got;
}

std::ptrdiff_t read_some_at(int fd, std::uint64_t offset, std::byte* to, std::size_t count) {
    OVERLAPPED place = at_offset(offset);
    DWORD got = 0;
    if (ReadFile(handle_of(fd), to, static_cast<DWORD>(std::min(count, kMostAtOnce)), &got, &place) != 0) return got;
    if (GetLastError() == ERROR_HANDLE_EOF) return 0;
    set_errno();
    return -1;
}

std::ptrdiff_t write_some_at(int fd, std::uint64_t offset, const std::byte* from, std::size_t count) {
    OVERLAPPED place = at_offset(offset);
    DWORD written = 0;
    if (WriteFile(handle_of(fd), from, static_cast<DWORD>(std::min(count, kMostAtOnce)), &written, &place) == 0) {
        set_errno();
        return -1;
    }
    if (written == 0 && count > 0) {
        errno = ENOSPC;
        return -1;
    }
    return written;
}

std::int64_t position_of(int fd) {
    const std::atomic<std::int64_t>* const position = position_in_file(fd);
    return position == nullptr ? -1 : position->load();
}

bool set_position(int fd, std::int64_t at) {
    std::atomic<std::int64_t>* const position = position_in_file(fd);
    if (position == nullptr || at < 0) {
        errno = ESPIPE;
        return false;
    }
    *position = at;
    return true;
}

}  // namespace tex::inline v1
