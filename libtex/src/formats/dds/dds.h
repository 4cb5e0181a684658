// SPDX-License-Identifier: Apache-2.0
// dds.h: DirectDraw Surface files, both directions (Microsoft: Programming Guide for DDS).
//
//     "DDS "  DDS_HEADER (124 bytes)  [DDS_HEADER_DXT10 (20 bytes)]  level 0  level 1 ...
//
// Levels follow each other without gaps; numbers are little-endian.

#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <tex/container.h>
#include <tex/result.h>
#include <tex/texture.h>

#include "formats/file_layout.h"
#include "formats/stored_texture.h"

namespace tex {

inline constexpr std::string_view kDdsMagic = "DDS ";

// Legacy where the options ask for it and Direct3D 9 has the format, else DX10. Three channels of 16 or 32 bits are
// widened. (DXGI has three floats of 32 bits; few readers know them.)
[[nodiscard]] FileLayout dds_layout(const TextureHead& head, const WriteOptions& options);

// Where the texels of a file of `size` bytes stand. Errors: bad_data, unsupported, as read_texture(); those of `fetch`.
// May throw std::bad_alloc.
[[nodiscard]] Result<StoredTexture> parse_dds(const FetchBytes& fetch, std::size_t size, const std::string& name,
                                              const ReadOptions& options);

}  // namespace tex
