// SPDX-License-Identifier: Apache-2.0
// height_source.h: which channels of a picture are its heights, and rows of them.

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <tex/height_field.h>

namespace tex {

// Where heights come from: one plane as it is, or a mixture of R, G and B.
struct HeightSource {
    HeightChannel mixture = HeightChannel::automatic;
    int plane = -1;  // else planes red, green and blue
    int red = 0, green = 0, blue = 0;
};

// Among channels of these names. Errors: bad_option.
Result<HeightSource> find_height_source(const std::vector<std::string>& names, HeightChannel channel);

// Nullopt where the blur's sigma is in range, else the error (bad_option).
std::optional<Error> check_blur(const HeightOptions& options);

// What was met in rows of heights.
struct HeightCounts {
    std::int64_t luma = 0;     // texels where `automatic` took luma
    std::int64_t invalid = 0;  // NaN, infinite or no-data texels: they are NaN now
};

// Row j of a picture as heights: taken, cleaned and inverted as the options say. Neither filled nor blurred.
HeightCounts take_heights(const Image& image, const HeightSource& source, const HeightOptions& options, int j,
                          float* out);

// What was found wrong, as a sentence: `invalid` of all texels, the first of them at (column, row).
Error invalid_heights(std::int64_t invalid, int column, int row, Extent extent, const HeightOptions& options);

}  // namespace tex
