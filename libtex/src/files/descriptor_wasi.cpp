// SPDX-License-Identifier: Apache-2.0

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

#include "files/descriptor.h"

namespace tex::inline v1 {
namespace {

FileStatus status_from(const struct stat& status) {
    constexpr std::int64_t kSecond = 1000000000;
    const auto nanoseconds = [](const timespec& time) { return std::int64_t{time.tv_sec} * kSecond + time.tv_nsec; };
    FileKind kind = FileKind::other;
    if (S_ISREG(status.st_mode)) kind = FileKind::regular;
    if (S_ISDIR(status.st_mode)) kind = FileKind::folder;
    if (S_ISBLK(status.st_mode) || S_ISCHR(status.st_mode)) kind = FileKind::device;
    return {kind,
            {status.st_dev, status.st_ino, status.st_size, nanoseconds(status.st_mtim), nanoseconds(status.st_ctim)}};
}

}  // namespace

void Descriptor::reset() {
    if (fd_ > kStandardOutput) ::close(fd_);  // streams cannot be copied: nobody owns them
    fd_ = -1;
}

std::optional<FileStatus> FileStatus::of(const std::string& path) {
    struct stat status {};
    if (path.empty()) errno = ENOENT;  // wasi-libc takes it for the working directory
    if (path.empty() || stat(path.c_str(), &status) != 0) return std::nullopt;
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
    return path == "-" ? Descriptor(kStandardInput) : Descriptor(::open(path.c_str(), O_RDONLY));
}

// There is no folder for temporary files.
Descriptor temporary_file(const std::string& folder) {
    constexpr int kMostWriters = 4096;
    errno = ENOTSUP;
    for (int k = 0; k < kMostWriters && !folder.empty(); ++k) {
        const std::string name = folder + "/.libtex.tex-tmp" + std::to_string(k);
        Descriptor file(::open(name.c_str(), O_RDWR | O_CREAT | O_EXCL, 0600));
        if (file) unlink(name.c_str());
        if (file || errno != EEXIST) return file;
    }
    return Descriptor();
}

std::ptrdiff_t read_some(int fd, std::byte* to, std::size_t count) { return ::read(fd, to, count); }

std::ptrdiff_t read_some_at(int fd, std::uint64_t offset, std::byte* to, std::size_t count) {
    return ::pread(fd, to, count, static_cast<off_t>(offset));
}

std::ptrdiff_t write_some_at(int fd, std::uint64_t offset, const std::byte* from, std::size_t count) {
    const ssize_t written = ::pwrite(fd, from, count, static_cast<off_t>(offset));
    if (written != 0 || count == 0) return written;
    errno = EIO;
    return -1;
}

std::int64_t position_of(int fd) { return lseek(fd, 0, SEEK_CUR); }

bool set_position(int fd, std::int64_t position) { return lseek(fd, position, SEEK_SET) >= 0; }

}  // namespace tex::inline v1
