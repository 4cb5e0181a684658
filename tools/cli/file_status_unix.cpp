// SPDX-License-Identifier: Apache-2.0

#include "cli/file_status.h"

#include <cerrno>
#include <filesystem>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace tex::cli {
namespace {

constexpr std::int64_t kSecond = 1000000000;

std::int64_t nanoseconds(const timespec& time) { return std::int64_t{time.tv_sec} * kSecond + time.tv_nsec; }

FileStatus status_from(const struct stat& status) {
    FileStatus result;
    if (S_ISREG(status.st_mode)) result.kind = FileKind::regular;
    if (S_ISDIR(status.st_mode)) result.kind = FileKind::folder;
    if (S_ISLNK(status.st_mode)) result.kind = FileKind::link;
    result.is_writable = (status.st_mode & (S_IWUSR | S_IWGRP | S_IWOTH)) != 0;
    result.device = static_cast<std::uint64_t>(status.st_dev);
    result.inode = static_cast<std::uint64_t>(status.st_ino);
    result.size = status.st_size;
#ifdef __APPLE__
    result.mtime = nanoseconds(status.st_mtimespec);
    result.ctime = nanoseconds(status.st_ctimespec);
#else
    result.mtime = nanoseconds(status.st_mtim);
    result.ctime = nanoseconds(status.st_ctim);
#endif
    return result;
}

int close_file(std::FILE* file) { return file == nullptr ? 0 : std::fclose(file); }

}  // namespace

std::optional<FileStatus> status_of(const std::string& path) {
    struct stat status {};
    // In wasi-libc, an empty path is the working directory.
    if (path.empty()) errno = ENOENT;
    if (path.empty() || stat(path.c_str(), &status) != 0) return std::nullopt;
    return status_from(status);
}

std::optional<FileStatus> status_of_link(const std::string& path) {
    struct stat status {};
    if (lstat(path.c_str(), &status) != 0) return std::nullopt;
    return status_from(status);
}

std::optional<FileStatus> status_of_open(int fd) {
    struct stat status {};
    if (fstat(fd, &status) != 0) return std::nullopt;
    return status_from(status);
}

std::optional<FileStatus> status_of_open(std::FILE* file) { return status_of_open(fileno(file)); }

ReadFile open_to_read(const std::string& path) { return {std::fopen(path.c_str(), "rbe"), close_file}; }

ReadFile open_at_once(const std::string& path, Links links, FileStatus& status) {
    const int no_links = links == Links::refused ? O_NOFOLLOW : 0;
    const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | no_links);
    ReadFile file(fd < 0 ? nullptr : fdopen(fd, "rb"), close_file);
    if (!file) {
        if (fd >= 0) close(fd);
        return file;
    }
    std::setvbuf(file.get(), nullptr, _IONBF, 0);  // whoever calls read_from() has a buffer
    const std::optional<FileStatus> found = status_of_open(fd);
    if (!found) return {nullptr, close_file};
    status = *found;
    return file;
}

std::optional<std::size_t> read_from(std::FILE* file, void* to, std::size_t count) {
    for (;;) {
        const std::size_t got = std::fread(to, 1, count, file);
        if (got > 0 || std::ferror(file) == 0) return got;
        if (errno != EINTR) return std::nullopt;
        std::clearerr(file);
    }
}

std::FILE* standard_input() { return stdin; }

bool set_mtime(const std::string& path, std::int64_t mtime) {
    const timespec times[] = {{0, UTIME_OMIT}, {mtime / kSecond, static_cast<long>(mtime % kSecond)}};
    return utimensat(AT_FDCWD, path.c_str(), times, 0) == 0;
}

std::error_code create_folders(const std::string& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    return error;
}

bool remove_file(const std::string& path) { return std::remove(path.c_str()) == 0; }

std::int64_t physical_memory() {
#ifdef __wasi__
    return std::int64_t{4} << 30;  // all that a module can have
#else
    return static_cast<std::int64_t>(sysconf(_SC_PHYS_PAGES)) * sysconf(_SC_PAGESIZE);
#endif
}

std::string key_of_name(const std::string& name) { return name; }

}  // namespace tex::cli
