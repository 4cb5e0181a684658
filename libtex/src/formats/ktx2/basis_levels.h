// SPDX-License-Identifier: Apache-2.0
// basis_levels.h: where a KTX2 file with BasisLZ has what its levels share, and the slices of each.

#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include <tex/types.h>

#include "formats/ktx2/basis_codebooks.h"
#include "formats/ktx2/unclaimed_bytes.h"
#include "formats/stored_texture.h"

namespace tex::inline v1 {

// Reads the global data of a file of `size` bytes that holds so many images: a level has one for each face of each
// layer. May throw std::bad_alloc. Errors: bad_data, unsupported; those of `fetch`. They do not name the file.
[[nodiscard]] Result<std::shared_ptr<const BasisCodebooks>> read_basis_global(const FetchBytes& fetch, std::size_t size,
                                                                              const ClaimedBytes& global,
                                                                              std::uint64_t images);

// The slices of one image of a level, which has these bytes. Precondition: read_basis_global() has succeeded for more
// than `image` images. Errors: as read_basis_global().
[[nodiscard]] Result<StoredTexture::Level> basis_level(const FetchBytes& fetch, std::size_t size,
                                                       const ClaimedBytes& global, std::uint64_t image,
                                                       const ClaimedBytes& level, Extent extent, Format format);

}  // namespace tex::inline v1
