// SPDX-License-Identifier: Apache-2.0
// png_filter.h: the filters of PNG (W3C PNG specification, section 9), which predict bytes from their neighbours.

#pragma once

#include <cstddef>
#include <cstdint>

namespace tex::inline v1 {

// Writes the number of a filter and the `count` filtered bytes of a row to `out`. The filter is the one whose
// differences, as signed bytes, have the smallest sum of magnitudes, and the first of several: the specification's
// heuristic, with libpng's result. `above` is the row above, of zeros for the first row; `step` is the number of bytes
// of a texel, at most 8. Precondition: `step` bytes of zero come before `row` and before `above`.
void filter_png_row(const std::uint8_t* row, const std::uint8_t* above, std::size_t count, std::size_t step,
                    std::uint8_t* out);

// Exchanges the two bytes of each of `count` samples.
void swap_sample_bytes(std::uint8_t* samples, std::size_t count);

}  // namespace tex::inline v1
