// SPDX-License-Identifier: Apache-2.0
// reader.h: reads and writes pictures with decoders that run in processes of their own.

#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tex/file.h>
#include <tex/format.h>
#include <tex/types.h>

#include "files/input_file.h"
#include "formats/file_layout.h"
#include "formats/reader/reader_child.h"

namespace tex::inline v1 {

// A picture that the reader process encodes once all of its rows are there. Until then, the rows wait in a file in
// memory.
class ReaderPicture {
public:
    // Errors: unsupported (the container cannot hold the format), bad_option (jpeg_quality), io, out_of_memory.
    static Result<ReaderPicture> open(Container container, const TextureHead& head, const WriteOptions& options);

    // Takes rows of head.format, beginning with row `first`. Rows may come in any order, from several threads. Errors:
    // io, out_of_memory.
    [[nodiscard]] Result<void> put(int first, std::span<const std::byte> rows) const;

    // Encodes the picture, after the last row. Errors: as encode_with_reader().
    [[nodiscard]] Result<std::vector<std::byte>> encode() const;

private:
    ReadOptions options_;
    std::string format_;  // a name of reader_rows.cpp
    Descriptor rows_;
    std::uint64_t row_bytes_ = 0;
};

// Encodes the base level of a texture as tiff, jpeg or webp: 8- and 16-bit unorm, half and float, as far as the
// container can hold them (see can_hold()). The bytes contain no date, host or program name. JPEG: no chroma
// subsampling. TIFF: deflate. Errors: as ReaderPicture.
Result<std::vector<std::byte>> encode_with_reader(const Texture& texture, Container container,
                                                  const WriteOptions& options);

// Makes a file that libtex can read of one that it does not decode itself. "exr/PART": part PART of an EXR file, with
// its channels and levels, uncompressed. The result is not to be trusted. Errors: those of ReaderProcess.
Result<InputFile> decode_with_reader(InputFile& file, const std::string& format, const ReadOptions& options);

// The program that decodes and encodes pictures of this format, a name of reader_rows.cpp.
ReaderProgram program_for(std::string_view format);

// Finds a reader program: tex-reader is options.reader, or the first of these places, relative to the folder of libtex,
// in which the installation or the build put it: ../libexec/libtex, ../../libexec/libtex (if libraries are in a folder
// for their architecture), the same folder. Others are in the folder of options.reader, or in one of the same places.
// Errors: io (a program of another package is not installed, or it is not there).
Result<std::string> find_reader(const ReadOptions& options, ReaderProgram program = ReaderProgram::pictures);

}  // namespace tex::inline v1
