// SPDX-License-Identifier: Apache-2.0
// ktx.h: reads KTX files of version 1 (Khronos, "KTX File Format Specification", version 1). They are not written: KTX2
// replaces them.

#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "formats/stored_texture.h"

namespace tex::inline v1 {

inline constexpr std::string_view kKtxMagic("\xABKTX 11\xBB\r\n\x1A\n", 12);

// Finds the texels: the formats of Format with blocks, and unsigned, signed and floating samples of 8, 16 and 32 bits
// in one to four channels, also with blue first. Files of either byte order; texels of more than a byte a sample must
// be little-endian. Rows are stored from the top unless KTXorientation says otherwise. For the rest, see
// ParseTexture.
Result<StoredTexture> parse_ktx(const FetchBytes& fetch, std::size_t size, const std::string& name,
                                const ReadOptions& options);

}  // namespace tex::inline v1
