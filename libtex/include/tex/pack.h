// SPDX-License-Identifier: Apache-2.0
// pack.h: normals to the bytes of a texture.

#pragma once

#include <cstddef>

#include <tex/execution.h>
#include <tex/image.h>
#include <tex/mip_chain.h>
#include <tex/pack_options.h>
#include <tex/result.h>
#include <tex/texture.h>

#pragma GCC visibility push(default)
namespace tex {

// Packs every level of a chain.
//
// Quantisation is described at Encoding (format.h). Block encodings: each channel of a 4x4 block is fitted on its own
// (x in BC3's alpha or the first block of BC5 and RG11, y in the green of BC3's colour block or their second block). If
// an extent is not a multiple of 4, texels outside repeat the last one and have no weight. In dxt5nm, R and B are 1 in
// both endpoints of every block, so that every decoder returns exactly 255. A flat block decodes to 127 or 128 in G and
// A under the rules of AMD, Intel and NVIDIA, within 0.23 degrees of (0, 0, 1).
//
// PackOptions::rdo optimises blocks for compression. If `rdo` is not null, it then gets what that has done; otherwise,
// and if an error occurs, it stays as it is.
//
// Precondition: components are finite.
// Errors: bad_option (the chain has no level, or levels of other extents than those of level_extent(), or both blue and
//         length; as validate(options)), out_of_memory, cancelled
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] Result<Texture> pack(const MipChain& chain, const PackOptions& options = {},
                                   const Execution& execution = {}, RdoReport* rdo = nullptr);

// The block encoders alone, for engines with their own memory and threads. Encodes x and y of a level, or of whole rows
// of its blocks.
//
// Rows need no padding and may have any stride. Row r of blocks (texel rows 4 r to 4 r + 3) starts at blocks + r *
// pitch; its block b (texel columns 4 b to 4 b + 3) starts 16 b bytes later. There are (height + 3) / 4 rows of (width
// + 3) / 4 blocks. The 16 bytes of a block are
//
//     dxt5nm            0 to 7: x, as BC3's alpha (BC4's layout); 8 to 15: y in the green of BC3's colours
//     bc5, bc5_snorm    0 to 7: x; 8 to 15: y; both in BC4's layout
//     eac_rg11, eac_rg11_snorm    0 to 7: x; 8 to 15: y; both in EAC's layout (R11)
//
// BC4's layout is two endpoints of 8 bits, then 16 indices of 3 bits, texel 0 in the lowest bits, little-endian. BC3's
// colours are two of 5, 6 and 5 bits, red highest, then 16 indices of 2 bits (Direct3D 11.3 Functional Specification,
// 19.5). Bytes and errors are the same as those of pack()
// without optimisation: PackOptions::rdo, which needs many rows of blocks at once, is ignored.
//
// Preconditions (asserted): x and y have the same extent, at least 1x1; options.encoding is one of the five; pitch is
// at least 16 bytes for each block of a row; components are finite. Allocates no memory and starts no threads:
// different rows of blocks may be encoded at the same time.
void encode_blocks(PlaneView<const float> x, PlaneView<const float> y, const PackOptions& options, std::byte* blocks,
                   std::size_t pitch);

}  // namespace tex
#pragma GCC visibility pop
