// SPDX-License-Identifier: Apache-2.0
// exr.h: OpenEXR, both directions, through the OpenEXR library.

#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <tex/image.h>
#include <tex/image_io.h>
#include <tex/result.h>
#include <tex/texture.h>

#include "files/input_file.h"
#include "formats/row_target.h"

namespace tex {

// Whether a file that begins with `head` is an EXR.
bool is_exr(std::span<const std::byte> head);

// Of the OpenEXR that libtex was built with.
const char* exr_version();
// Of the libdeflate that it was built with, which inflates ZIP.
const char* inflater_version();

// Reads an EXR as read_image() promises: the data window, at its largest level; of several parts the first. Planes R,
// G, B and A come first, then the others by name. Half and float are as stored, uint is divided by 2^32 - 1.
//
// Errors: bad_data (with OpenEXR's reason), unsupported (deep data, subsampled channels, too large), io, out_of_memory.
Result<Image> read_exr(InputFile& file, const ReadOptions& options);

// Reads an EXR with its mip levels as a float texture: the channels R, G, B (and A), else all channels where there are
// at most four. The attributes normalEncoding and normalYAxis tell Texture::normal_encoding and Texture::y_axis. Levels
// that follow another rule than level_extent() (ripmaps, extents rounded up) are left out, with a remark.
//
// Errors: as read_exr(); unsupported where more than four channels lack R, G, B.
Result<Texture> read_exr_texture(InputFile& file, const ReadOptions& options);

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
