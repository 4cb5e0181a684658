// SPDX-License-Identifier: Apache-2.0
// astc_file.h: reads and writes .astc, the files of Arm's astcenc: one level of ASTC blocks.
//
//     magic (4 bytes)  sides of a block in texels: x, y, z (1 byte each)  extent: x, y, z (3 bytes each)  blocks
//
// Numbers are little-endian. The file states neither the layout nor the direction of y.

#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <tex/file.h>
#include <tex/types.h>

#include "formats/file_layout.h"
#include "formats/stored_texture.h"

namespace tex::inline v1 {

inline constexpr std::string_view kAstcMagic = "\x13\xab\xa1\x5c";

[[nodiscard]] bool holds_astc(Format format);

// Precondition: the format is ASTC, and there is one level.
[[nodiscard]] FileLayout astc_layout(const TextureHead& head, const WriteOptions& options);

// Finds the blocks of a file of `size` bytes. Errors: bad_data, unsupported, as read_texture(); those of `fetch`. May
// throw std::bad_alloc.
[[nodiscard]] Result<StoredTexture> parse_astc(const FetchBytes& fetch, std::size_t size, const std::string& name,
                                               const ReadOptions& options);

}  // namespace tex::inline v1
