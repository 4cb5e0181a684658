// SPDX-License-Identifier: Apache-2.0
// bmp.h: reads and writes BMP files, of all versions of Windows, and those of OS/2 as far as Windows knows them.

#pragma once

#include <memory>
#include <string_view>

#include <tex/file.h>
#include <tex/types.h>

#include "files/input_file.h"
#include "formats/row_source.h"
#include "formats/row_target.h"

namespace tex::inline v1 {

inline constexpr std::string_view kBmpMagic = "BM";

// Opens a BMP to be read row by row: R, G, B, and A if a mask says so; Y if the palette holds greys alone, which is how
// BMP stores grey. (The fourth byte of 32-bit texels without masks is not used.) Masks of equal size, or of divisors of
// the largest, give samples of that many bits, others samples of 8 or 16 bits, as OpenImageIO widens them. Texels that
// RLE skips have the first colour. Rows come from the top. The file must outlive the rows; several threads may decode
// at once. A file with RLE is first read once to find where its rows begin.
//
// Errors: bad_data (damaged, or shorter than its header says), unsupported (too large; JPEG, PNG, Huffman codes and RLE
// of 24 bits in a BMP; other depths than 1, 2, 4, 8, 16, 24 and 32), io, out_of_memory.
Result<std::unique_ptr<RowSource>> open_bmp(InputFile& file, const ReadOptions& options);

// Writes the base level of a texture in r8_unorm, with a palette of greys, or rgb8_unorm: uncompressed, rows from the
// bottom, as Windows 3. Errors: unsupported (the extent, another format), those of WriteBytes.
Result<std::unique_ptr<RowTarget>> open_bmp_target(const TextureHead& head, WriteBytes write);

}  // namespace tex::inline v1
