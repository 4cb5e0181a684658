// SPDX-License-Identifier: Apache-2.0
// pack_rows.h: packs rows of normals into the bytes of a texture.

#pragma once

#include <cstddef>

#include <tex/pack.h>
#include <tex/types.h>

#include "kernels/normal_row.h"
#include "kernels/pack.h"
#include "rows/rdo_rows.h"

namespace tex::inline v1 {

// Packs rows [begin, end) of a level, or of a strip of one, that is `height` rows high (at most the height of `map`).
// `begin` is a multiple of the height of a block. If blocks are encoded, `end` is such a multiple too, or equals the
// height; rows that the last block lacks repeat the last row. `out` is where row 0 goes.
//
// If is_optimised(options), rows are optimised in bands; `begin` is then a multiple of their rows, and `end` too,
// unless it is the height. `tally` may be null. Throws std::bad_alloc.
//
// `plain`, unless it is null, gets the blocks as they are without optimisation, at the same places as `out`.
//
// `extras`: those of the map that are stored, in the channels that can_hold() names.
void pack_rows(const NormalMap& map, ExtraSet extras, int height, const PackOptions& options, int begin, int end,
               std::byte* out, const RdoBands& bands, RdoTally* tally = nullptr, std::byte* plain = nullptr);

// The swizzle of a texture of this encoding that also holds these data. Alpha stays a constant there: whether it is one
// is known only after the last row.
[[nodiscard]] Swizzle swizzle_with(Encoding encoding, ExtraSet beside);

// Packs `count` texels of a format without blocks. `channels` are those of the format (kernels/pack.h); whole vectors
// of them are read. `out` has room for kPackSlack more texels. Returns the bytes of the texels.
std::size_t pack_texels(const FormatInfo& format, const PackChannel* channels, int count, std::byte* out);

// The channels of a texture with this swizzle; `blue` and `alpha` are what its other channels hold.
void pack_channels(VectorRow normals, const Swizzle& swizzle, bool negate_y, const float* blue, const float* alpha,
                   PackChannel out[4]);

}  // namespace tex::inline v1
