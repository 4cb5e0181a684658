// SPDX-License-Identifier: Apache-2.0
// exr_chunk.h: whether the compressed bytes of a chunk (some scan lines, or a tile) hold all its texels.
//
// OpenEXR 3.1 takes a chunk that decodes to fewer bytes than its texels have, and leaves in the rest what was in memory before.

#pragma once

#include <cstddef>

#include <ImfCompression.h>

namespace tex {

// How many scan lines a chunk of a file with scan lines has (its last one may have fewer).
[[nodiscard]] int chunk_lines(Imf::Compression compression);

// True where `size` bytes decode to no fewer than `wanted` bytes, as far as OpenEXR does not check that itself: it does for PXR24, PIZ and B44, but for chunks
// without a byte. (DWA is not checked: which of its buffers a channel comes from is said by rules in the chunk.) ZIP is inflated once more for it.
[[nodiscard]] bool chunk_is_whole(Imf::Compression compression, const std::byte* data, std::size_t size, std::size_t wanted);

}  // namespace tex
