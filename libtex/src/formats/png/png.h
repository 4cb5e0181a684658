// SPDX-License-Identifier: Apache-2.0
// png.h: reads and writes PNG files. libpng reads and writes what comes before the texels. png_rows.h reads the rows of
// almost all files, and libpng those of the others; png_block.h compresses rows.

#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include <tex/file.h>
#include <tex/format.h>
#include <tex/types.h>

#include "files/input_file.h"
#include "formats/row_source.h"
#include "formats/row_target.h"

namespace tex::inline v1 {

// The first four bytes of a PNG. A transfer in text mode damages the bytes after them.
inline constexpr std::string_view kPngMagic = "\x89PNG";

// The version of the libpng that is running.
const char* png_version();

// Opens a PNG to be read row by row as read_image() describes: grey as Y, colour and palette as R, G, B, alpha or tRNS
// as A; values are code / (2^bits - 1); gAMA, sRGB, iCCP and sBIT change nothing. Damaged ancillary chunks also count
// as damage. The rows of an interlaced PNG are held in memory, as they are decoded. A damaged file is read twice:
// libpng finds the reason. `file` must outlive the rows.
//
// Errors: bad_data (with libpng's reason), unsupported (too large), io, out_of_memory.
Result<std::unique_ptr<RowSource>> open_png(InputFile& file, const ReadOptions& options);

// Opens through libpng alone: the files of open_png() are read, with the same texels. Tests compare the two.
Result<std::unique_ptr<RowSource>> open_png_with_libpng(InputFile& file, const ReadOptions& options);

// Writes the base level of a texture row by row, with the bytes of encode_png(). The work of the target is to filter
// and compress blocks of rows. Errors: unsupported (another format), out_of_memory.
Result<std::unique_ptr<RowTarget>> open_png_target(const TextureHead& head, WriteBytes write);

// Encodes the base level of a texture in an 8- or 16-bit unorm format: one channel as grey, three as RGB, four as RGBA.
// Equal textures give equal bytes (with one version of zlib), on any number of threads.
//
// Errors: unsupported (another format), out_of_memory.
Result<std::vector<std::byte>> encode_png(const Texture& texture);

// Encodes a level with one byte for each texel, which is an index into the colours. Precondition: 1 to 256 colours, and
// every byte is the index of a colour. Errors: unsupported (libpng's reason), out_of_memory.
struct PngColor {
    std::uint8_t r, g, b;
    friend auto operator<=>(const PngColor&, const PngColor&) = default;
};
Result<std::vector<std::byte>> encode_indexed_png(const Level& indices, const std::vector<PngColor>& palette);

}  // namespace tex::inline v1
