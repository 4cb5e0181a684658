// SPDX-License-Identifier: Apache-2.0
// bmp_header.h: what the headers and the palette of a BMP say.

#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <tex/file.h>
#include <tex/types.h>

#include "files/input_file.h"

namespace tex::inline v1 {

inline constexpr std::size_t kBmpFileHeader = 14;
inline constexpr std::uint32_t kBmpCoreHeader = 12, kBmpInfoHeader = 40;  // both count themselves

// The bits of a texel that hold a channel.
struct BmpField {
    int shift = 0;
    int bits = 0;
};

struct BmpHeader {
    Extent extent;
    bool from_top = false;
    bool is_rle = false;
    int depth = 0;                                     // bits of a texel
    std::int64_t first = 0;                            // the place of the first texel
    std::vector<std::array<std::uint8_t, 3>> palette;  // R, G, B; empty if texels hold the channels
    bool is_grey = false;                              // all colours of the palette are
    std::vector<BmpField> fields;                      // of R, G, B and perhaps A
    int bits = 8;                                      // of the samples

    // Bytes of a row that is not compressed; rows begin at multiples of four bytes.
    [[nodiscard]] std::size_t row_bytes() const { return (static_cast<std::size_t>(extent.width) * depth_() + 7) / 8; }
    [[nodiscard]] std::size_t stride() const { return (row_bytes() + 3) & ~std::size_t{3}; }

private:
    [[nodiscard]] std::size_t depth_() const { return static_cast<std::size_t>(depth); }
};

// Reads the headers of a file whose size is known. Errors: as open_bmp().
Result<BmpHeader> read_bmp_header(const InputFile& file, const ReadOptions& options);

}  // namespace tex::inline v1
