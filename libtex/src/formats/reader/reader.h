// SPDX-License-Identifier: Apache-2.0
// reader.h: pictures through OpenImageIO, which lives in a process of its own.

#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <tex/container.h>
#include <tex/image_io.h>
#include <tex/result.h>
#include <tex/texture.h>

#include "files/input_file.h"
#include "formats/file_layout.h"

namespace tex {

// A picture that the reader process encodes once all of its rows are there; until then they wait in a file in memory.
class ReaderPicture {
public:
    // Errors: unsupported (the container does not hold the format), io, out_of_memory.
    static Result<ReaderPicture> open(Container container, const TextureHead& head, const ReadOptions& options);

    // Rows of head.format, the row `first` and those below it. They may come in any order, from several threads.
    // Errors: io, out_of_memory.
    [[nodiscard]] Result<void> put(int first, std::span<const std::byte> rows) const;

    // After the last row. Errors: as encode_with_reader().
    [[nodiscard]] Result<std::vector<std::byte>> encode() const;

private:
    ReadOptions options_;
    std::string format_;  // as OpenImageIO names it
    Descriptor rows_;
    std::uint64_t row_bytes_ = 0;
};

// Encodes the base level of a texture as tiff, tga, bmp or jpeg: 8- and 16-bit unorm, half and float, as far as the
// container goes (see can_hold()). No date, host or program name in the bytes. JPEG: quality 95, no chroma subsampling.
// TIFF: deflate. Errors: io, unsupported, out_of_memory.
Result<std::vector<std::byte>> encode_with_reader(const Texture& texture, Container container,
                                                  const ReadOptions& options);

// The reader program: options.reader, or where the installation or the build put it, seen from libtex:
// ../libexec/libtex, ../../libexec/libtex (where libraries lie in a folder for their architecture), the same folder.
// Errors: io.
Result<std::string> find_reader(const ReadOptions& options);

}  // namespace tex
