// SPDX-License-Identifier: Apache-2.0
// open_input.h: the input, opened once more by each decoder, because the position of its descriptor is the caller's.

#pragma once

#include <cstdio>
#include <memory>
#include <vector>

#include <ImfIO.h>
#include <ImfMultiPartInputFile.h>
#include <tiffio.h>

namespace tex::reader {

// False if it cannot be read, or is empty.
bool read_whole_input(std::vector<unsigned char>& bytes);

// Null if it cannot be opened.
TIFF* open_tiff_input();

// The stream, if there is one, must outlive the file. Throws what OpenEXR throws.
Imf::MultiPartInputFile open_exr_input(std::unique_ptr<Imf::IStream>& stream, int threads);

}  // namespace tex::reader
