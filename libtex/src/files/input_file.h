// SPDX-License-Identifier: Apache-2.0
// input_file.h: files that are read.
//
// Files are read, never mapped: a file that another process shortens meanwhile ends early, and does not end this
// process.

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tex/image_io.h>
#include <tex/result.h>

namespace tex {

// Owns a file descriptor; -1 is none.
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

// A file open for reading: a regular file, a FIFO, a socket, standard input ("-"), or bytes in memory. Bytes come in
// order through read(); where size() is known, read_at() reads anywhere without moving that order.
class InputFile {
public:
    // Errors: io (missing, no permission, a directory, a device), bad_data (empty), out_of_memory.
    static Result<InputFile> open(const std::string& path);
    // Bytes that are in memory already; `name` stands in the messages. Errors: bad_data (empty), out_of_memory.
    static Result<InputFile> from_memory(const std::string& name, std::vector<std::byte> bytes);

    [[nodiscard]] const std::string& path() const { return path_; }  // as the caller gave it
    // Bytes of a regular file when it was opened; nullopt where only the end of the stream tells.
    [[nodiscard]] std::optional<std::int64_t> size() const { return size_; }
    // A descriptor of the whole file, for another process that opens or reads it from its beginning; nullopt for
    // streams and bytes in memory.
    [[nodiscard]] std::optional<int> whole_file() const;
    // Makes size() known: takes a stream into memory, to its end. Errors: as read_rest().
    Result<void> settle(std::int64_t limit);
    // The first bytes of the file, kHeadBytes or all there are; reading does not change them.
    static constexpr std::size_t kHeadBytes = 64;
    [[nodiscard]] std::span<const std::byte> head() const { return head_; }

    // Reads the next `count` bytes; fewer only at the end of the file. Errors: io.
    Result<std::size_t> read(std::byte* data, std::size_t count);
    // read() begins at the first byte again. Precondition: size() is known. Errors: io.
    Result<void> rewind();
    // Reads `count` bytes at `offset`; fewer only at the end of the file. Precondition: size() is known. Errors: io.
    Result<std::size_t> read_at(std::int64_t offset, std::byte* data, std::size_t count) const;
    // Reads all that read() has not yet read. More than `limit` bytes are unsupported. Errors: io, unsupported,
    // out_of_memory.
    Result<std::vector<std::byte>> read_rest(std::int64_t limit);

private:
    InputFile() = default;

    std::string path_;
    Descriptor fd_;
    std::optional<std::int64_t> size_;
    std::int64_t start_ = 0;  // the offset at which the file begins: standard input may be a file that was read in part
    std::optional<std::vector<std::byte>> memory_;  // instead of fd_
    std::vector<std::byte> head_;
    std::size_t position_ = 0;  // in memory_ or head_, as far as read() has come
};

// The most bytes that a file of options.max_texels texels has: 16 bytes a texel, a mip chain's third on top, and a
// header.
std::int64_t largest_file(const ReadOptions& options);

// All bytes of a file or of standard input ("-"). Errors: those of InputFile::open() and
// read_rest(largest_file(options)).
Result<std::vector<std::byte>> read_whole_file(const std::string& path, const ReadOptions& options = {});

}  // namespace tex
