// SPDX-License-Identifier: Apache-2.0
// descriptor.h: open files, by the numbers of the C library, and what the system says about files. descriptor_posix.cpp
// and descriptor_windows.cpp implement it.
//
// Functions that fail set errno.

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace tex::inline v1 {

inline constexpr int kStandardInput = 0, kStandardOutput = 1;

// Owns a file descriptor; -1 means none.
class Descriptor {
public:
    Descriptor() = default;
    explicit Descriptor(int fd) : fd_(fd) {}
    Descriptor(Descriptor&& other) noexcept : fd_(other.release()) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        if (this != &other) {
            reset();
            fd_ = other.release();
        }
        return *this;
    }
    ~Descriptor() { reset(); }

    [[nodiscard]] int get() const { return fd_; }
    explicit operator bool() const { return fd_ >= 0; }
    int release() {
        const int fd = fd_;
        fd_ = -1;
        return fd;
    }
    void reset();

private:
    int fd_ = -1;
};

// What the system says about a regular file. While it stays the same, so do the contents.
struct FileVersion {
    std::uint64_t device = 0, inode = 0;
    std::int64_t size = 0;
    std::int64_t mtime = 0, ctime = 0;  // in nanoseconds

    friend bool operator==(const FileVersion&, const FileVersion&) = default;
    // Nothing if the path leads to no regular file.
    static std::optional<FileVersion> of(const std::string& path);
};

enum class FileKind { regular, folder, device, other };  // other: FIFOs, sockets

struct FileStatus {
    FileKind kind = FileKind::other;
    FileVersion version;

    // Nothing if there is no such file.
    static std::optional<FileStatus> of(const std::string& path);
    static std::optional<FileStatus> of(int fd);
};

// Opens a file for reading; "-" is a copy of standard input. A FIFO is waited for.
Descriptor open_for_reading(const std::string& path);

// A new file that nobody else can open and that is gone when it is closed, on the disk that holds `folder`; an empty
// `folder` is that for temporary files.
Descriptor temporary_file(const std::string& folder);

// Read up to `count` bytes: the next ones, or those at an offset. They return how many; 0 at the end of the file, -1 if
// the system refuses.
std::ptrdiff_t read_some(int fd, std::byte* to, std::size_t count);
std::ptrdiff_t read_some_at(int fd, std::uint64_t offset, std::byte* to, std::size_t count);
// Writes at least one and up to `count` bytes; -1 if the system refuses.
std::ptrdiff_t write_some_at(int fd, std::uint64_t offset, const std::byte* from, std::size_t count);

// Where read_some() reads next; -1 if the file is a stream.
std::int64_t position_of(int fd);
bool set_position(int fd, std::int64_t position);

}  // namespace tex::inline v1
