// SPDX-License-Identifier: Apache-2.0
// basis_inflater.h: reads levels that BasisLZ compresses, as ETC1S blocks.

#pragma once

#include <memory>

#include "formats/ktx2/level_inflater.h"
#include "formats/stored_texture.h"

namespace tex::inline v1 {

// For LevelInflater::make(). The codebooks of the texture must outlive the inflater.
std::unique_ptr<LevelInflater> make_basis_inflater(const StoredTexture& texture, FetchBytes fetch,
                                                   const StoredTexture::Level& place);

}  // namespace tex::inline v1
