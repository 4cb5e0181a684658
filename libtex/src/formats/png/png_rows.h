// SPDX-License-Identifier: Apache-2.0
// png_rows.h: decodes the rows of plain PNG files (png_texels.h) that are not interlaced.

#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <tex/types.h>

#include "formats/png/png_expand.h"
#include "formats/png/png_texels.h"
#include "kernels/png_unfilter.h"

namespace tex::inline v1 {

class PlainPngRows {
public:
    // The header of the first IDAT chunk, which has `length` bytes, has been read. Throws std::bad_alloc. The input
    // must outlive this object.
    PlainPngRows(PngInput& input, std::uint32_t length, Extent extent, const PngKind& kind);

    // Decodes the next rows as expanded texels (png_expand.h), `row_bytes` apart. False if the file is not plain; some
    // rows may then have been changed. Errors: io.
    [[nodiscard]] Result<bool> decode(int count, std::size_t row_bytes, std::uint8_t* rows);
    // Checks what follows the last row. False if the file is not plain. Errors: io.
    [[nodiscard]] Result<bool> finish() { return texels_.finish(); }

private:
    [[nodiscard]] Result<bool> fill();
    // Row -1 is the row above the held ones.
    [[nodiscard]] std::uint8_t* row(int k) {
        return held_.data() + kPngZeros + static_cast<std::size_t>(k + 1) * stride_;
    }

    const Extent extent_;
    const PngKind kind_;
    const std::size_t count_;   // bytes of a row of the file
    const std::size_t stride_;  // from row to row
    const int most_;            // rows that are unfiltered together
    PngTexels texels_;
    std::vector<std::uint8_t> held_;  // rows without filters
    int held_rows_ = 0;
    int given_ = 0;  // of them
    int next_ = 0;   // the first row that is not held
};

}  // namespace tex::inline v1
