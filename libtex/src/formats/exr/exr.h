// SPDX-License-Identifier: Apache-2.0
// exr.h: writes OpenEXR files. The OpenEXR library makes the header; libdeflate compresses the texels.

#pragma once

#include <cstddef>
#include <memory>
#include <string_view>
#include <vector>

#include <tex/format.h>
#include <tex/types.h>

#include "formats/row_target.h"

namespace tex::inline v1 {

inline constexpr std::string_view kExrMagic = "\x76\x2f\x31\x01";

// The version of OpenEXR that libtex was built with.
const char* exr_version();
// The version of libdeflate, which compresses and inflates ZIP, that libtex was built with.
const char* inflater_version();

// Writes a half or float texture row by row, with the bytes of encode_exr(). The compressed tiles of smaller levels
// wait until the larger levels are complete (exr_waiting.h). Errors: those of encode_exr(), io.
Result<std::unique_ptr<RowTarget>> open_exr_target(const TextureHead& head, WriteBytes write);

// Encodes a half or float texture with ZIP compression. A texture of more than one level is stored in tiles of 64x64
// with mip levels, others in scanlines. Attributes: normalEncoding "signed", normalYAxis "up" or "down". No date, owner
// or comment: equal textures give equal bytes.
//
// Errors: unsupported (another format; more than one level, but not all that EXR requires: level_count()),
// out_of_memory.
Result<std::vector<std::byte>> encode_exr(const Texture& texture);

}  // namespace tex::inline v1
