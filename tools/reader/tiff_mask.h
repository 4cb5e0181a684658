// SPDX-License-Identifier: Apache-2.0
// tiff_mask.h: the mask of a TIFF file, another picture in it, which says which texels hold data.

#pragma once

#include <tiffio.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "tiff_chunks.h"

namespace tex::reader {

struct TiffCloser {
    void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};
using TiffFile = std::unique_ptr<TIFF, TiffCloser>;

// The rows of a mask, from the top. Texels whose mask is 0 hold no data (TIFF 6.0, NewSubfileType 4; GDAL writes such
// files with GDAL_TIFF_INTERNAL_MASK=YES).
class TiffMask {
public:
    // Takes the file whose current directory is the mask.
    explicit TiffMask(TiffFile file);

    [[nodiscard]] bool is_sound() const { return chunks_.is_sound(); }
    // Sets mask[i] to 0 where texel i of row y holds no data, to another value elsewhere. False if it is damaged.
    bool read_row(std::uint32_t y, const std::byte*& mask);

private:
    TiffFile file_;
    TiffLayout layout_;
    Samples samples_;
    TiffChunks chunks_;
    std::vector<std::byte> rows_;
    std::uint32_t first_ = 0, end_ = 0;  // the rows that are in rows_
};

// Opens the mask of the first picture, at which `tiff` is, and which has this layout. Null if there is none that can be
// read.
std::unique_ptr<TiffMask> open_mask(TIFF* tiff, const TiffLayout& layout);

}  // namespace tex::reader
