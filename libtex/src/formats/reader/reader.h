// SPDX-License-Identifier: Apache-2.0
// reader.h: pictures through OpenImageIO, which lives in a process of its own.

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <tex/container.h>
#include <tex/image_io.h>
#include <tex/result.h>
#include <tex/texture.h>

namespace tex {

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
