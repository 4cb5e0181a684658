// SPDX-License-Identifier: Apache-2.0

#include "cli/file_status.h"

#include <algorithm>
#include <cerrno>

#include <fcntl.h>
#include <io.h>
#include <windows.h>

#include "files/descriptor.h"
#include "files/wide_windows.h"

namespace tex::cli {
namespace {

constexpr DWORD kShared = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;

int close_file(std::FILE* file) { return file == nullptr ? 0 : std::fclose(file); }

FileStatus status_from(const tex::FileStatus& found) {
    FileStatus status;
    if (found.kind == tex::FileKind::regular) status.kind = FileKind::regular;
    if (found.kind == tex::FileKind::folder) status.kind = FileKind::folder;
    status.device = found.version.device;
    status.inode = found.version.inode;
    status.size = found.version.size;
    status.mtime = found.version.mtime;
    status.ctime = found.version.ctime;
    return status;
}

ReadFile opened(const std::string& path, DWORD flags) {
    const std::wstring full = system_path(path);
    if (full.empty()) return {nullptr, close_file};
    HANDLE handle = CreateFileW(full.c_str(), GENERIC_READ, kShared, nullptr, OPEN_EXISTING, flags, nullptr);
    if (handle == INVALID_HANDLE_VALUE) {
        set_errno();
        return {nullptr, close_file};
    }
    const int fd = _open_osfhandle(reinterpret_cast<intptr_t>(handle), _O_RDONLY | _O_BINARY | _O_NOINHERIT);
    if (fd < 0) {
        CloseHandle(handle);
        return {nullptr, close_file};
    }
    std::FILE* const file = _fdopen(fd, "rb");
    if (file == nullptr) _close(fd);
    return {file, close_file};
}

}  // namespace

std::optional<FileStatus> status_of(const std::string& path) {
    const auto found = tex::FileStatus::of(path);
    if (!found) return std::nullopt;
    FileStatus status = status_from(*found);
    const DWORD attributes = GetFileAttributesW(system_path(path).c_str());
    status.is_writable = attributes == INVALID_FILE_ATTRIBUTES || (attributes & FILE_ATTRIBUTE_READONLY) == 0;
    return status;
}

std::optional<FileStatus> status_of_link(const std::string& path) {
    const std::wstring full = system_path(path);
    const DWORD attributes = full.empty() ? INVALID_FILE_ATTRIBUTES : GetFileAttributesW(full.c_str());
    if (!full.empty() && attributes == INVALID_FILE_ATTRIBUTES) set_errno();
    if (attributes == INVALID_FILE_ATTRIBUTES) return std::nullopt;
    if ((attributes & FILE_ATTRIBUTE_REPARSE_POINT) == 0) return status_of(path);
    FileStatus link;
    link.kind = FileKind::link;
    return link;
}

std::optional<FileStatus> status_of_open(int fd) {
    const auto found = tex::FileStatus::of(fd);
    if (!found) return std::nullopt;
    return status_from(*found);
}

std::optional<FileStatus> status_of_open(std::FILE* file) { return status_of_open(_fileno(file)); }

ReadFile open_to_read(const std::string& path) { return opened(path, FILE_ATTRIBUTE_NORMAL); }

ReadFile open_at_once(const std::string& path, Links links, FileStatus& status) {
    ReadFile file = opened(path, links == Links::refused ? FILE_FLAG_OPEN_REPARSE_POINT : FILE_ATTRIBUTE_NORMAL);
    if (!file) return file;
    std::setvbuf(file.get(), nullptr, _IONBF, 0);  // whoever calls read_from() has a buffer
    const auto found = links == Links::refused ? status_of_link(path) : status_of_open(_fileno(file.get()));
    if (!found) return {nullptr, close_file};
    status = *found;
    return file;
}

std::optional<std::size_t> read_from(std::FILE* file, void* to, std::size_t count) {
    const std::size_t got = std::fread(to, 1, count, file);
    if (got == 0 && std::ferror(file) != 0) return std::nullopt;
    return got;
}

std::FILE* standard_input() {
    _setmode(_fileno(stdin), _O_BINARY);
    return stdin;
}

bool set_mtime(const std::string& path, std::int64_t mtime) {
    HANDLE handle = CreateFileW(system_path(path).c_str(), FILE_WRITE_ATTRIBUTES, kShared, nullptr, OPEN_EXISTING,
                                FILE_FLAG_BACKUP_SEMANTICS, nullptr);
    if (handle == INVALID_HANDLE_VALUE) return false;
    const auto ticks = static_cast<std::uint64_t>(filetime_of(mtime));
    const FILETIME time{static_cast<DWORD>(ticks), static_cast<DWORD>(ticks >> 32)};
    const bool done = SetFileTime(handle, nullptr, nullptr, &time) != 0;
    CloseHandle(handle);
    return done;
}

std::error_code create_folders(const std::string& folder) {
    const std::wstring full = system_path(folder);
    if (full.empty()) return {errno, std::generic_category()};
    // From the first folder that is there.
    std::size_t end = full.size();
    const auto exists = [&] { return GetFileAttributesW(full.substr(0, end).c_str()) != INVALID_FILE_ATTRIBUTES; };
    while (end != 0 && end != std::wstring::npos && !exists()) end = full.rfind(L'\\', end - 1);
    if (end == 0 || end == std::wstring::npos) return {ENOENT, std::generic_category()};
    while (end < full.size()) {
        end = std::min(full.find(L'\\', end + 1), full.size());
        if (CreateDirectoryW(full.substr(0, end).c_str(), nullptr) == 0 && GetLastError() != ERROR_ALREADY_EXISTS)
            return {set_errno(), std::generic_category()};
    }
    const auto made = status_of(folder);
    return made && made->kind == FileKind::folder ? std::error_code()
                                                  : std::error_code(ENOTDIR, std::generic_category());
}

bool remove_file(const std::string& path) {
    const std::wstring full = system_path(path);
    if (full.empty()) return false;
    if (DeleteFileW(full.c_str()) != 0) return true;
    set_errno();
    return false;
}

std::int64_t physical_memory() {
    MEMORYSTATUSEX memory{};
    memory.dwLength = sizeof memory;
    return GlobalMemoryStatusEx(&memory) != 0 ? static_cast<std::int64_t>(memory.ullTotalPhys) : std::int64_t{4} << 30;
}

std::string key_of_name(const std::string& name) {
    std::wstring text = wide(name);
    if (!text.empty()) CharUpperBuffW(text.data(), static_cast<DWORD>(text.size()));
    return text.empty() ? name : narrow(text);
}

}  // namespace tex::cli
