// SPDX-License-Identifier: Apache-2.0
// input_file.h: files that libtex reads.
//
// Files are read, never mapped into memory. If another process shortens the file meanwhile, the file ends early, but
// this process does not crash.

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tex/file.h>
#include <tex/types.h>

namespace tex::inline v1 {

// Owns a file descriptor; -1 means none.
class Descriptor {
public:
    Descriptor() = default;
    explicit Descriptor(int fd) : fd_(fd) {}
    Descriptor(Descriptor&& other) noexcept : fd_(other.release()) {}
    Descriptor& operator=(Descriptor&& other) noexcept;
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

// What stat() says about a regular file. While it stays the same, so do the contents.
struct FileVersion {
    std::uint64_t device = 0, inode = 0;
    std::int64_t size = 0;
    std::int64_t mtime = 0, ctime = 0;  // in nanoseconds

    friend bool operator==(const FileVersion&, const FileVersion&) = default;
    // Nothing if the path leads to no regular file.
    static std::optional<FileVersion> of(const std::string& path);
};

// A file open for reading: a regular file, a FIFO, a socket, standard input ("-"), or bytes in memory. read() returns
// the bytes in order. If size() is known, read_at() reads from any offset without changing the position of read().
class InputFile {
public:
    // Errors: io (missing, no permission, a directory, a device), bad_data (empty), out_of_memory.
    static Result<InputFile> open(const std::string& path);
    // Opens bytes that are already in memory; error messages call them `name`. Errors: bad_data (empty), out_of_memory.
    static Result<InputFile> from_memory(const std::string& name, std::vector<std::byte> bytes);

    // A file that is already open, from the byte `start` on; error messages call it `name`. Errors: io, bad_data
    // (empty).
    static Result<InputFile> from_descriptor(const std::string& name, Descriptor fd, std::int64_t start);

    [[nodiscard]] const std::string& path() const { return path_; }  // as the caller gave it
    // The size in bytes of a regular file when it was opened; nullopt if only the end of the stream reveals the size.
    [[nodiscard]] std::optional<std::int64_t> size() const { return size_; }
    // A descriptor of the whole file, for another process that opens it or reads it from its beginning; nullopt for
    // streams and bytes in memory.
    [[nodiscard]] std::optional<int> whole_file() const;
    // Makes size() known: reads a stream to its end into memory. Errors: as read_rest().
    Result<void> settle(std::int64_t limit);
    // The first bytes of the file, kHeadBytes or the whole file if it is shorter. They do not depend on how far read()
    // has come.
    static constexpr std::size_t kHeadBytes = 64;
    [[nodiscard]] std::span<const std::byte> head() const { return head_; }

    // Reads the next `count` bytes; fewer only at the end of the file. Errors: io.
    Result<std::size_t> read(std::byte* data, std::size_t count);
    // Sets read() back to the first byte. Precondition: size() is known. Errors: io.
    Result<void> rewind();
    // Reads `count` bytes at `offset`; fewer only at the end of the file. Precondition: size() is known. Errors: io.
    Result<std::size_t> read_at(std::int64_t offset, std::byte* data, std::size_t count) const;
    // Reads all bytes that read() has not returned yet. Errors: io, unsupported (more than `limit` bytes),
    // out_of_memory.
    Result<std::vector<std::byte>> read_rest(std::int64_t limit);

private:
    InputFile() = default;
    Result<void> read_head();

    std::string path_;
    Descriptor fd_;
    std::optional<std::int64_t> size_;
    std::int64_t start_ = 0;  // where the file begins: standard input may be a file that was partly read
    std::optional<std::vector<std::byte>> memory_;  // replaces fd_
    std::vector<std::byte> head_;
    std::size_t position_ = 0;  // the position of read() in memory_ or head_
};

// The file that read_texture(path, options) reads: options.bytes, if there are any. Errors: those of InputFile::open().
Result<InputFile> open_input(const std::string& path, const ReadOptions& options);

// The largest size in bytes of a file with options.max_texels texels: 16 bytes a texel, one third more for a mip chain,
// and a header.
std::int64_t largest_file(const ReadOptions& options);

// Reads all bytes of a file or of standard input ("-"). Errors: those of InputFile::open() and
// read_rest(largest_file(options)).
Result<std::vector<std::byte>> read_whole_file(const std::string& path, const ReadOptions& options = {});

}  // namespace tex::inline v1
