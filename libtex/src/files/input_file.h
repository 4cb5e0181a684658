// SPDX-License-Identifier: Apache-2.0
// input_file.h: files that libtex reads.
//
// Files are read, never mapped into memory. If another process shortens the file meanwhile, the file ends early, but
// this process does not crash.

#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tex/file.h>
#include <tex/types.h>

#include "files/descriptor.h"

namespace tex::inline v1 {

// A file open for reading: a regular file, a FIFO, a socket, standard input ("-"), or bytes in memory. read() returns
// the bytes in order. If size() is known, read_at() reads from any offset without changing the position of read().
class InputFile {
public:
    // Errors: io (missing, no permission, a directory, a device), bad_data (empty), out_of_memory.
    static Result<InputFile> open(const std::string& path);
    // Opens bytes that are already in memory; error messages call them `name`. Errors: bad_data (empty), out_of_memory.
    static Result<InputFile> from_memory(const std::string& name, std::vector<std::byte> bytes);
    static Result<InputFile> from_memory(const std::string& name, std::shared_ptr<const std::vector<std::byte>> bytes);

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
    std::shared_ptr<const std::vector<std::byte>> memory_;  // replaces fd_
    std::vector<std::byte> head_;
    std::size_t position_ = 0;  // the position of read() in memory_ or head_
};

// The file that read_texture(path, options) reads: options.bytes, if there are any. Errors: those of InputFile::open().
Result<InputFile> open_input(const std::string& path, const ReadOptions& options);

// The largest size in bytes of a file with options.max_texels texels: 16 bytes a texel, one third more for a mip chain,
// and a header.
std::int64_t largest_file(const ReadOptions& options);

}  // namespace tex::inline v1
