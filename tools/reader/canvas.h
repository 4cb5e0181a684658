// SPDX-License-Identifier: Apache-2.0
// canvas.h: hands over pictures as their orientation says.

#pragma once

#include <cstddef>
#include <vector>

#include "reader.h"

namespace tex::reader {

// Why pictures of these kinds are refused, and what converts them.
inline constexpr char kCmykReason[] =
    "a CMYK picture, which is not read; ImageMagick makes it RGB: convert FILE -colorspace sRGB RGB.png";
inline constexpr char kDeepReason[] =
    "deep data have no single value for a texel; OpenImageIO flattens them: oiiotool FILE --flatten -o FLAT.exr";

// Takes the rows of a picture in the order of the file, and hands them over turned as its orientation says (1 to 8, as
// in TIFF and EXIF; other values count as 1). Rows that are not turned are handed over at once.
class Canvas {
public:
    // The header describes the picture as the file stores it.
    explicit Canvas(ReaderHeader& header) : header_(header) {}
    // Calls begin_picture(); afterwards the header has the extent of the turned picture.
    bool begin(const Task& task);
    void put(const void* rows, int count);
    void end();  // after the last row

private:
    ReaderHeader& header_;
    std::size_t width_ = 0, height_ = 0, pixel_ = 0;  // as stored
    std::vector<std::byte> waiting_;                  // the rows of a picture that will be turned
};

}  // namespace tex::reader
