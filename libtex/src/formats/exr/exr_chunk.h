// SPDX-License-Identifier: Apache-2.0
// exr_chunk.h: whether the compressed bytes of a chunk (some scan lines, or a tile) hold all its texels.
//
// OpenEXR 3.1 takes a chunk that decodes to fewer bytes than its texels have, and leaves in the rest what was in memory
// before.

#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <ImfCompression.h>

struct libdeflate_decompressor;

namespace tex {

// How many scan lines a chunk of a file with scan lines has (its last one may have fewer).
[[nodiscard]] int chunk_lines(Imf::Compression compression);

// Decodes chunks of ZIP and ZIPS: to look whether they are whole takes as long as to decode them.
class Unzipper {
public:
    Unzipper();
    // The texels of a chunk, `wanted` bytes of them, as the file orders them: line by line, in each the channels by
    // name. They stay until the next call, and no longer than `chunk`. Empty where it is damaged or holds fewer. A
    // chunk of which nothing is left out has `most` bytes. Throws std::bad_alloc.
    std::span<const std::byte> texels(std::span<const std::byte> chunk, std::size_t wanted, std::size_t most);

private:
    std::unique_ptr<libdeflate_decompressor, void (*)(libdeflate_decompressor*)> inflater_;
    std::vector<std::byte> inflated_, texels_;
};

// True where a chunk decodes to no fewer than `wanted` bytes, as far as OpenEXR does not check that itself: it does for
// PXR24, PIZ and B44, but for chunks without a byte. ZIP is `Unzipper`'s, DWA dwa_is_whole()'s: true here.
[[nodiscard]] bool chunk_is_whole(Imf::Compression compression, std::span<const std::byte> chunk, std::size_t wanted);

}  // namespace tex
