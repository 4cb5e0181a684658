// SPDX-License-Identifier: Apache-2.0
// dds.h: reads and writes DirectDraw Surface files (Microsoft: Programming Guide for DDS).
//
//     "DDS "  DDS_HEADER (124 bytes)  [DDS_HEADER_DXT10 (20 bytes)]  level 0  level 1 ...
//
// Levels follow each other without gaps; numbers are little-endian.

#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <tex/file.h>
#include <tex/format.h>
#include <tex/types.h>

#include "formats/file_layout.h"
#include "formats/stored_texture.h"

namespace tex::inline v1 {

inline constexpr std::string_view kDdsMagic = "DDS ";

// The header is legacy if the options ask for it and Direct3D 9 has the format, otherwise DX10. Formats of three
// channels with 16 or 32 bits are widened. (DXGI has a format of three 32-bit floats, but few readers support it.)
[[nodiscard]] FileLayout dds_layout(const TextureHead& head, const WriteOptions& options);

// Finds the texels of a file of `size` bytes. Errors: bad_data, unsupported, as read_texture(); those of `fetch`. May
// throw std::bad_alloc.
[[nodiscard]] Result<StoredTexture> parse_dds(const FetchBytes& fetch, std::size_t size, const std::string& name,
                                              const ReadOptions& options);

}  // namespace tex::inline v1
