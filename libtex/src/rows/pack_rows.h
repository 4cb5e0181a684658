// SPDX-License-Identifier: Apache-2.0
// pack_rows.h: rows of normals to the bytes of a texture.

#pragma once

#include <cstddef>

#include <tex/normal_map.h>
#include <tex/pack.h>

namespace tex {

// Packs rows [begin, end) of a level, or of a strip of one, that is `height` rows high (at most those of `map`).
// `begin` is a multiple of the height of a block; where blocks are encoded, so is `end`, or it is the height, and rows
// of the last block that are not there repeat the last one. `out` is where row 0 goes.
void pack_rows(const NormalMap& map, int height, const PackOptions& options, int begin, int end, std::byte* out);

}  // namespace tex
