// SPDX-License-Identifier: Apache-2.0
// png_unfilter.h: undoes the filters of PNG (W3C PNG specification, section 9).

#pragma once

#include <cstddef>
#include <cstdint>

namespace tex::inline v1 {

// The most rows that are unfiltered together, and the fewest bytes between the rows in memory: the first 192 of them
// are scratch, the last 128 are zeros.
inline constexpr int kPngRowsTogether = 15;
inline constexpr std::size_t kPngRowGap = 320;
inline constexpr std::size_t kPngZeros = 128;

// Undoes the filters of `rows` rows (1 to kPngRowsTogether) of `count` bytes in place. The first row begins `stride`
// bytes after `above`, which is the row above them without a filter, or zeros; the others follow at the same distance.
// filters[k] is the number of the filter of row k, 0 to 4. `step` is the number of bytes of a texel: 1, 2, 3, 4, 6
// or 8.
//
// Preconditions: stride >= count + kPngRowGap; kPngZeros bytes before each row, and before `above`, are zeros (and
// remain so); there is scratch for 192 bytes after the last row.
void unfilter_png_rows(std::uint8_t* above, std::size_t stride, std::size_t count, std::size_t step, int rows,
                       const std::uint8_t* filters);

}  // namespace tex::inline v1
