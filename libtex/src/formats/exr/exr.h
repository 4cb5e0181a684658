// SPDX-License-Identifier: Apache-2.0
// exr.h: OpenEXR, both directions, through the OpenEXR library.

#pragma once

#include <cstddef>
#include <memory>
#include <string_view>
#include <vector>

#include <tex/result.h>
#include <tex/texture.h>

#include "formats/row_target.h"

namespace tex {

inline constexpr std::string_view kExrMagic = "\x76\x2f\x31\x01";

// Of the OpenEXR that libtex was built with.
const char* exr_version();
// Of the libdeflate that it was built with, which inflates ZIP.
const char* inflater_version();

// Writes a half or float texture row by row, with the bytes of encode_exr(). The tiles of smaller levels wait in
// memory, compressed, for the end of the larger ones. Errors: those of encode_exr().
Result<std::unique_ptr<RowTarget>> open_exr_target(const TextureHead& head, WriteBytes write);

// Encodes a half or float texture: ZIP compression; tiles of 64x64 and mip levels where the texture has more than one
// level, else scanlines. Attributes: normalEncoding "signed", normalYAxis "up" or "down". No date, owner or comment:
// equal textures give equal bytes.
//
// Errors: unsupported (another format; more than one level, but not all that EXR wants: level_count()), out_of_memory.
Result<std::vector<std::byte>> encode_exr(const Texture& texture);

}  // namespace tex
