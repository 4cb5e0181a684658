// SPDX-License-Identifier: Apache-2.0
// exr_chunk.h: whether the compressed bytes of a chunk (some scan lines, or a tile) hold all its texels.
//
// OpenEXR 3.1 accepts a chunk that decodes to fewer bytes than its texels need. It leaves the previous contents of the
// memory in the other texels.

#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <ImfCompression.h>

struct libdeflate_decompressor;

namespace tex {

// The number of scan lines in a chunk of a scanline file (the last chunk may have fewer).
[[nodiscard]] int chunk_lines(Imf::Compression compression);

// Decodes chunks of ZIP and ZIPS. Checking that they are whole takes as long as decoding them.
class Unzipper {
public:
    Unzipper();
    // Decodes a chunk to its texels, `wanted` bytes in the order of the file: line by line, and in each line the
    // channels by name. The result is valid until the next call, and no longer than `chunk`. It is empty if the chunk
    // is damaged or holds fewer bytes. A chunk from which nothing is cut off has `most` bytes. Throws std::bad_alloc.
    std::span<const std::byte> texels(std::span<const std::byte> chunk, std::size_t wanted, std::size_t most);

private:
    std::unique_ptr<libdeflate_decompressor, void (*)(libdeflate_decompressor*)> inflater_;
    std::vector<std::byte> inflated_, texels_;
};

// Whether a chunk decodes to at least `wanted` bytes, for compressions that OpenEXR does not check itself. OpenEXR
// checks PXR24, PIZ and B44, except chunks without a byte. `Unzipper` checks ZIP, and dwa_is_whole() checks DWA; this
// function returns true for both.
[[nodiscard]] bool chunk_is_whole(Imf::Compression compression, std::span<const std::byte> chunk, std::size_t wanted);

}  // namespace tex
