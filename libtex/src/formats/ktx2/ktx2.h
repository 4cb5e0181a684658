// SPDX-License-Identifier: Apache-2.0
// ktx2.h: reads and writes KTX 2.0 files (Khronos: KTX File Format Specification, version 2.0).
//
//     identifier  header  level index  data format descriptor  key/value data  levels, the smallest first

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

inline constexpr std::string_view kKtx2Magic = "\xabKTX 20\xbb\r\n\x1a\n";

// Formats of three channels with 16 or 32 bits are widened. If the swizzle is known, the key "libtex.normal" holds it:
// "dxt5nm" or the four letters of to_string(), followed by a blank and "+y" or "-y" if the direction of y is known.
[[nodiscard]] FileLayout ktx2_layout(const TextureHead& head);

// Finds the texels of a file of `size` bytes. Errors: bad_data, unsupported, as read_texture(); those of `fetch`. May
// throw std::bad_alloc.
[[nodiscard]] Result<StoredTexture> parse_ktx2(const FetchBytes& fetch, std::size_t size, const std::string& name,
                                               const ReadOptions& options);

}  // namespace tex::inline v1
