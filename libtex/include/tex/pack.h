// SPDX-License-Identifier: Apache-2.0
// pack.h: normals to the bytes of a texture.

#pragma once

#include <tex/execution.h>
#include <tex/mip_chain.h>
#include <tex/names.h>
#include <tex/result.h>
#include <tex/texture.h>

namespace [[gnu::visibility("default")]] tex {

// How hard the block encoders look for the smallest error (dxt5nm, bc5 and bc5_snorm; the others are exact). With normal and best no channel of
// a block has a greater squared error than a plain fit gives: endpoints at the extremes, twice refined by linear least squares, of values
// rounded to 1/128 of a code. With best none could have a smaller one. fast does not check what it found: it refines once, and the root mean
// square error of a block may exceed that of the palette between the extremes, before these are rounded, by what rounding does: half a code (of 255) in
// BC4 blocks, one where their range is less, 2.8 in dxt5nm's green (where that palette leaves 1/16 of the range at both ends), and 1/400 of the range.
enum class Effort { fast, normal, best };

inline constexpr Named<Effort> kEffortNames[] = {
    {Effort::fast, "fast", "for previews and iteration"},
    {Effort::normal, "normal", "close to the optimum"},
    {Effort::best, "best", "the least squared error"},
};

struct PackOptions {
    Encoding encoding = Encoding::dxt5nm;
    YAxis y_axis = YAxis::up;  // of the texture: down stores -y
    Effort effort = Effort::normal;
};

// Packs every level of a chain.
//
// Quantisation is described at Encoding (format.h). Block encodings: each channel of a 4x4 block is fitted by
// itself (x in BC3's alpha or BC5's first block, y in the green of BC3's colour block or BC5's second block).
// Where an extent is not a multiple of 4, texels outside repeat the last one and carry no weight. In
// dxt5nm R and B are 1 in both endpoints of every block, so that they decode to exactly 255 on every decoder, and
// a flat block decodes to 127 or 128 in G and A under the rules of AMD, Intel and NVIDIA, within 0.23 degrees of (0, 0, 1).
//
// Preconditions (asserted): the chain has at least one level and each level the extent of level_extent();
// components are finite.
// Errors: out_of_memory, cancelled.
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] Result<Texture> pack(const MipChain& chain, const PackOptions& options = {},
                                   const Execution& execution = {});

}  // namespace tex
