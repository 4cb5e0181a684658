// SPDX-License-Identifier: Apache-2.0
// exr_rows.h: the rows of an EXR file, which is stored in scanlines or tiles.

#pragma once

#include <memory>

#include <tex/file.h>
#include <tex/types.h>

#include "files/input_file.h"
#include "formats/row_source.h"
#include "formats/texture_rows.h"

namespace tex::inline v1 {

// Opens an EXR file to be read as read_image() describes, a few rows at a time. Several threads may decode at once. The
// picture is the data window, at its largest level; of several parts it is the first. Planes R, G, B and A come first,
// then the others by name. Half and float are as stored, uint is divided by 2^32 - 1
// or stays as it is after store_numbers(). `file` must outlive the rows.
//
// Errors: bad_data (with OpenEXR's reason), unsupported (deep data, subsampled channels, too large), io, out_of_memory.
Result<std::unique_ptr<RowSource>> open_exr_rows(InputFile& file, const ReadOptions& options);

// Opens a texture, with its mip levels. The channels are R, G, B (and A); in a file without them, all channels
// if there are at most four. The attributes normalEncoding and normalYAxis set Texture::normal_encoding and
// Texture::y_axis. Levels that follow another rule than level_extent() (ripmaps, extents rounded up) are left out, with
// a remark. Errors: as open_exr_rows(); unsupported if there are more than four channels and R, G or B is missing.
Result<TextureRows> open_exr_texture_rows(InputFile& file, const ReadOptions& options);

}  // namespace tex::inline v1
