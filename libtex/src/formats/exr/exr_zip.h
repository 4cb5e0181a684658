// SPDX-License-Identifier: Apache-2.0
// exr_zip.h: chunks (some scan lines, or a tile) that are compressed with ZIP or ZIPS.

#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

struct libdeflate_compressor;
struct libdeflate_decompressor;

namespace tex::inline v1 {

// Decodes chunks. Checking that they are whole takes as long as decoding them.
class Unzipper {
public:
    // Throws std::bad_alloc.
    Unzipper();
    // Decodes a chunk to its texels, `wanted` bytes in the order of the file: line by line, and in each line the
    // channels by name. The result is valid until the next call, and no longer than `chunk`. It is empty if the chunk
    // is damaged or holds fewer bytes. A chunk from which nothing is cut off has `most` bytes. Throws std::bad_alloc.
    std::span<const std::byte> texels(std::span<const std::byte> chunk, std::size_t wanted, std::size_t most);

private:
    std::unique_ptr<libdeflate_decompressor, void (*)(libdeflate_decompressor*)> inflater_;
    std::vector<std::byte> inflated_, texels_;
};

// Encodes chunks. It takes longer to make than to use again.
class Zipper {
public:
    // Throws std::bad_alloc.
    Zipper();
    // Encodes `texels`, at least one byte in the order of the file. The result has at most as many bytes, and is valid
    // until the next call or change of `texels`, which are lost. Throws std::bad_alloc.
    std::span<const std::byte> chunk();

    std::vector<std::byte> texels;

private:
    std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> deflater_;
    std::vector<std::byte> differences_;
};

}  // namespace tex::inline v1
