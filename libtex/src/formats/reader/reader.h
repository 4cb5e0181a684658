// SPDX-License-Identifier: Apache-2.0
// reader.h: pictures through OpenImageIO, which lives in a process of its own.

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <tex/container.h>
#include <tex/image.h>
#include <tex/image_io.h>
#include <tex/result.h>
#include <tex/texture.h>

#include "files/input_file.h"

namespace tex {

// Decodes a file in the reader process. Its first bytes choose the decoder: TIFF, JPEG, BMP, HDR, PSD, GIF, WebP, PNM,
// SGI, JPEG 2000, DPX, Cineon, IFF, Softimage PIC; a plausible header alone makes a TGA, which has no mark. Raw values,
// unassociated alpha, the first picture of several; orientation tags change nothing. Integers of fewer bits than their
// container (12-bit TIFF) are taken back to code / (2^n - 1).
//
// Errors: io           the reader program is not there or cannot be started
//         bad_data     not a picture; damaged; the decoder crashed, did not end within options.reader_timeout, or
//         handed over nonsense unsupported  CMYK; WebP with alpha; more than kMaxReaderChannels channels; too large;
//         more memory than options.reader_memory out_of_memory
Result<Image> read_with_reader(InputFile& file, const ReadOptions& options);
Result<Image> read_with_reader(const std::string& path, const ReadOptions& options);

// Encodes the base level of a texture as tiff, tga, bmp or jpeg: 8- and 16-bit unorm, half and float, as far as the
// container goes (see can_hold()). No date, host or program name in the bytes. JPEG: quality 95, no chroma subsampling.
// TIFF: deflate. Errors: io, unsupported, out_of_memory.
Result<std::vector<std::byte>> encode_with_reader(const Texture& texture, Container container,
                                                  const ReadOptions& options);

// The reader program: options.reader, or where the installation or the build put it, seen from libtex:
// ../libexec/libtex, ../../libexec/libtex (where libraries lie in a folder for their architecture), the same folder.
// Errors: io.
Result<std::string> find_reader(const ReadOptions& options);

}  // namespace tex
