// SPDX-License-Identifier: Apache-2.0
// file_status.h: what the commands ask the system about files, and the few things that they do to files themselves. All
// else goes through libtex. Each system has a source of its own (file_status_*.cpp).
//
// Paths are UTF-8 on Windows, and any bytes elsewhere. Functions that fail set errno.

#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <system_error>

namespace tex::cli {

// Descriptors.
inline constexpr int kStandardInput = 0, kStandardOutput = 1;

enum class FileKind { regular, folder, link, special };  // special: FIFOs, devices, sockets

struct FileStatus {
    FileKind kind = FileKind::special;
    bool is_writable = true;              // somebody may write it
    std::uint64_t device = 0, inode = 0;  // two names of one file have the same
    std::int64_t size = 0;
    std::int64_t mtime = 0;  // this and ctime in nanoseconds
    std::int64_t ctime = 0;  // the last change of anything, which no program can set

    [[nodiscard]] bool is_regular() const { return kind == FileKind::regular; }
};

// What a path leads to. Nothing if there is no such file.
[[nodiscard]] std::optional<FileStatus> status_of(const std::string& path);
// What the last name is itself, if it is a link.
[[nodiscard]] std::optional<FileStatus> status_of_link(const std::string& path);
[[nodiscard]] std::optional<FileStatus> status_of_open(int fd);
[[nodiscard]] std::optional<FileStatus> status_of_open(std::FILE* file);

// A file that is read as bytes.
using ReadFile = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;
[[nodiscard]] ReadFile open_to_read(const std::string& path);
// Opens without waiting for the writer of a FIFO, and returns its status. `links`: whether a link is followed.
enum class Links { followed, refused };
[[nodiscard]] ReadFile open_at_once(const std::string& path, Links links, FileStatus& status);
// Reads up to `count` bytes; 0 at the end of the file. Nothing if the system refuses.
[[nodiscard]] std::optional<std::size_t> read_from(std::FILE* file, void* to, std::size_t count);
// Standard input, as bytes.
[[nodiscard]] std::FILE* standard_input();

// Sets the time of the last change of contents, in nanoseconds.
bool set_mtime(const std::string& path, std::int64_t mtime);

// Creates a folder and those above it, if they are missing.
[[nodiscard]] std::error_code create_folders(const std::string& folder);

// Removes a file or a link. False if that fails.
bool remove_file(const std::string& path);

// Bytes of memory that the machine has.
[[nodiscard]] std::int64_t physical_memory();

// A name as this system compares names: without regard to case on Windows.
[[nodiscard]] std::string key_of_name(const std::string& name);

}  // namespace tex::cli
