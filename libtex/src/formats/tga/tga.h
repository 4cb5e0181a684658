// SPDX-License-Identifier: Apache-2.0
// tga.h: reads and writes TGA files, of version 1 and 2 (Truevision TGA File Format Specification, version 2.0).

#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include <tex/file.h>
#include <tex/types.h>

#include "files/input_file.h"
#include "formats/row_source.h"
#include "formats/row_target.h"

namespace tex::inline v1 {

// Whether a file that begins with these bytes may be a TGA. It has no magic number: its header is plausible.
bool may_be_tga(std::span<const std::byte> head);

// Opens a TGA to be read row by row: grey as Y, colour and palettes as R, G, B, with A if there is alpha. 15 and 16
// bits are three codes of 5 bits. Rows come from the top and texels from the left, whatever the file's order. The file
// must outlive the rows; several threads may decode at once.
//
// Alpha: a texel of 32 bits has it, unless the footer says that it is undefined and may be ignored, or both the footer
// and the header that there is none. Grey of 16 bits and palettes of 32 bits have it if the header counts 8 bits for
// it. Colour that has been multiplied by alpha stays as it is: the division would lose bits and, where alpha is 0, all
// of them; and alpha may be a height.
//
// RLE packets may cross rows, so that such a file is first read once to find where its rows begin.
//
// Errors: bad_data (damaged, or shorter than its header says), unsupported (too large; depths that the specification
// does not have; interleaved rows), io, out_of_memory.
Result<std::unique_ptr<RowSource>> open_tga(InputFile& file, const ReadOptions& options);

// Writes the base level of a texture in an 8-bit unorm format of one, three or four channels: uncompressed, rows from
// the bottom, which all programs read, and with an extension area. Errors: unsupported (the extent, another format),
// those of WriteBytes.
Result<std::unique_ptr<RowTarget>> open_tga_target(const TextureHead& head, WriteBytes write);

}  // namespace tex::inline v1
