// SPDX-License-Identifier: Apache-2.0
// exr_chunk.h: whether the compressed bytes of a chunk (some scan lines, or a tile) hold all its texels.
//
// OpenEXR 3.1 accepts a chunk that decodes to fewer bytes than its texels need. It leaves the previous contents of the
// memory in the other texels.

#pragma once

#include <cstddef>
#include <span>

#include <ImfCompression.h>

namespace tex {

// The number of scan lines in a chunk of a scanline file (the last chunk may have fewer).
[[nodiscard]] int chunk_lines(Imf::Compression compression);

// Whether a chunk decodes to at least `wanted` bytes, for compressions that OpenEXR does not check itself. OpenEXR
// checks PXR24, PIZ and B44, except chunks without a byte. `Unzipper` (exr_zip.h) checks ZIP, and dwa_is_whole() checks
// DWA; this function returns true for both.
[[nodiscard]] bool chunk_is_whole(Imf::Compression compression, std::span<const std::byte> chunk, std::size_t wanted);

}  // namespace tex
