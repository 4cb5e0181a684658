// SPDX-License-Identifier: Apache-2.0
// exr_chunk.h: decodes chunks (some scan lines, or a tile) of an EXR file.

#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <ImfCompression.h>

#include "formats/exr/exr_zip.h"

namespace tex::inline v1 {

// Whether ChunkDecoder knows the compression: none, RLE, ZIPS and ZIP. tex-reader decodes the others.
[[nodiscard]] bool is_decoded_here(Imf::Compression compression);

// The number of scan lines in a chunk of these compressions (the last chunk may have fewer).
[[nodiscard]] int chunk_lines(Imf::Compression compression);

class ChunkDecoder {
public:
    // Decodes a chunk to its texels, `wanted` bytes in the order of the file: line by line, and in each line the
    // channels by name. The result is valid until the next call, and no longer than `chunk`. It is empty if the chunk
    // is damaged or holds fewer bytes. A chunk from which nothing is cut off has `most` bytes. Throws std::bad_alloc.
    // Precondition: is_decoded_here(compression).
    std::span<const std::byte> texels(Imf::Compression compression, std::span<const std::byte> chunk,
                                      std::size_t wanted, std::size_t most);

    std::vector<std::byte> bytes;  // for the caller, who may keep a chunk in it

private:
    std::span<const std::byte> unrolled(std::span<const std::byte> chunk, std::size_t wanted, std::size_t most);

    Unzipper unzipper_;
    std::vector<std::byte> runs_, texels_;
};

}  // namespace tex::inline v1
