// SPDX-License-Identifier: Apache-2.0
// bmp_rle.h: the indices of a BMP that is compressed with RLE8 or RLE4.

#pragma once

#include <cstdint>
#include <vector>

#include <tex/types.h>

#include "files/input_file.h"
#include "formats/bmp/bmp_header.h"

namespace tex::inline v1 {

// Where a row begins. Codes may skip whole rows, and the beginning of a row.
struct BmpRowStart {
    std::int64_t place = 0;
    int column = 0;
    bool is_skipped = false;
};

// The starts of all rows in the order of the file, and where the last one ends. Throws std::bad_alloc. Errors:
// bad_data, io.
Result<std::vector<BmpRowStart>> find_bmp_rows(const InputFile& file, const BmpHeader& header);

// Writes an index for each texel of rows [first, first + count), in the order of the file. Throws std::bad_alloc.
// Errors: as find_bmp_rows().
Result<void> read_bmp_rows(const InputFile& file, const BmpHeader& header, const std::vector<BmpRowStart>& starts,
                           int first, int count, std::uint8_t* indices);

}  // namespace tex::inline v1
