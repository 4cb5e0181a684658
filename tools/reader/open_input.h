// SPDX-License-Identifier: Apache-2.0
// open_input.h: the input, opened once more by each decoder, because the position of its descriptor is the caller's.

#pragma once

#include <cstdio>
#include <memory>
#include <vector>

#include <ImfIO.h>
#include <ImfMultiPartInputFile.h>
#include <jpeglib.h>  // needs cstdio
#include <tiffio.h>

namespace tex::reader {

// What libjpeg-turbo reads from; it must outlive the codec.
struct JpegInput {
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file{nullptr, std::fclose};
    std::vector<unsigned char> bytes;
};

// False if it cannot be opened.
bool open_jpeg_input(jpeg_decompress_struct& codec, JpegInput& input);

// Null if it cannot be opened.
TIFF* open_tiff_input();

// The stream, if there is one, must outlive the file. Throws what OpenEXR throws.
Imf::MultiPartInputFile open_exr_input(std::unique_ptr<Imf::IStream>& stream, int threads);

}  // namespace tex::reader
