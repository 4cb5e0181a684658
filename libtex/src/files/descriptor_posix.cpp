// SPDX-License-Identifier: Apache-2.0

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "files/descriptor.h"

namespace tex::inline v1 {
namespace {

// Systems refuse or shorten larger counts.
constexpr std::size_t kMostAtOnce = std::size_t{1} << 30;

// Calls `once`, and again as long as a signal interrupts it.
template <class Once>
auto uninterrupted(const Once& once) {
    for (;;) {
        const auto result = once();
        if (result >= 0 || errno != EINTR) return result;
    }
}

FileStatus status_from(const struct stat& status) {
    constexpr std::int64_t kSecond = 1000000000;
    const auto nanoseconds = [](const timespec& time) { return std::int64_t{time.tv_sec} * kSecond + time.tv_nsec; };
#ifdef __APPLE__
    const timespec &modified = status.st_mtimespec, &changed = status.st_ctimespec;
#else
    const timespec &modified = status.st_mtim, &changed = status.st_ctim;
#endif
    FileKind kind = FileKind::other;
    if (S_ISREG(status.st_mode)) kind = FileKind::regular;
    if (S_ISDIR(status.st_mode)) kind = FileKind::folder;
    if (S_ISBLK(status.st_mode) || S_ISCHR(status.st_mode)) kind = FileKind::device;
    return {kind,
            {static_cast<std::uint64_t>(status.st_dev), static_cast<std::uint64_t>(status.st_ino), status.st_size,
             nanoseconds(modified), nanoseconds(changed)}};
}

}  // namespace

void Descriptor::reset() {
    if (fd_ >= 0) ::close(fd_);
    fd_ = -1;
}

std::optional<FileStatus> FileStatus::of(const std::string& path) {
    struct stat status {};
    if (stat(path.c_str(), &status) != 0) return std::nullopt;
    return status_from(status);
}

std::optional<FileStatus> FileStatus::of(int fd) {
    struct stat status {};
    if (fstat(fd, &status) != 0) return std::nullopt;
    return status_from(status);
}

std::optional<FileVersion> FileVersion::of(const std::string& path) {
    const std::optional<FileStatus> status = FileStatus::of(path);
    if (!status || status->kind != FileKind::regular) return std::nullopt;
    return status->version;
}

Descriptor open_for_reading(const std::string& path) {
    return Descriptor(uninterrupted([&] {
        return path == "-" ? fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 0)
                           : ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY);
    }));
}

Descriptor temporary_file(const std::string& folder) {
    std::error_code error;  // if it fails, the path is empty, and so is the descriptor
    std::string name = folder.empty() ? std::filesystem::temp_directory_path(error).string() : folder;
    name += "/.tex-tmpXXXXXX";
    Descriptor file(mkstemp(name.data()));
    if (file) {
        fcntl(file.get(), F_SETFD, FD_CLOEXEC);
        unlink(name.c_str());
    }
    return file;
}

std::ptrdiff_t read_some(int fd, std::byte* to, std::size_t count) {
    return uninterrupted([&] { return ::read(fd, to, std::min(count, kMostAtOnce)); });
}

std::ptrdiff_t read_some_at(int fd, std::uint64_t offset, std::byte* to, std::size_t count) {
    return uninterrupted([&] { return ::pread(fd, to, std::min(count, kMostAtOnce), static_cast<off_t>(offset)); });
}

std::ptrdiff_t write_some_at(int fd, std::uint64_t offset, const std::byte* from, std::size_t count) {
    const auto written =
        uninterrupted([&] { return ::pwrite(fd, from, std::min(count, kMostAtOnce), static_cast<off_t>(offset)); });
    if (written == 0 && count > 0) {
        errno = EIO;
        return -1;
    }
    return written;
}

std::int64_t position_of(int fd) { return lseek(fd, 0, SEEK_CUR); }

bool set_position(int fd, std::int64_t position) { return lseek(fd, position, SEEK_SET) >= 0; }

}  // namespace tex::inline v1
