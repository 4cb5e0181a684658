// SPDX-License-Identifier: Apache-2.0
// height_source.h: finds the channels of a picture that hold its heights, and reads rows of them.

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tex/height.h>

namespace tex::inline v1 {

class LinearRows;

// What a picture says about its values, as Image does.
struct PictureFacts {
    std::vector<std::string> names;
    SampleKind sample = SampleKind::unorm;
    int bits = 8;
    bool stored = false;
    double scale = 1.0, offset = 0.0;
    std::optional<float> no_data;
    bool is_masked = false;  // some texels are made NaN, because the file says by a mask that they hold no data
};

[[nodiscard]] PictureFacts facts_of(const Image& image);

// The source of heights: one unchanged plane, or a mixture of R, G and B.
struct HeightSource {
    HeightChannel mixture = HeightChannel::automatic;
    int plane = -1;  // -1: use the planes red, green and blue
    int red = 0, green = 0, blue = 0;
    int alpha = -1;            // the plane whose zeros are texels without data, if the mixture has one
    bool has_numbers = false;  // the values are numbers, not fractions
};

// Finds the source among the picture's channels. Errors: bad_option.
Result<HeightSource> find_height_source(const PictureFacts& facts, const HeightOptions& options);

// What was found in rows of heights.
struct HeightCounts {
    std::int64_t luma = 0;         // texels for which `automatic` took luma
    std::int64_t invalid = 0;      // NaN, infinite or no-data texels, which are now NaN
    std::int64_t implausible = 0;  // as in HeightReport
    // For heights in bytes: sums of the steps from each texel to the next one of its row.
    std::int64_t red_steps = 0, green_steps = 0;

    HeightCounts& operator+=(const HeightCounts& other) {
        luma += other.luma;
        invalid += other.invalid;
        implausible += other.implausible;
        red_steps += other.red_steps;
        green_steps += other.green_steps;
        return *this;
    }
};

[[nodiscard]] inline HeightReport report_of(const HeightCounts& counts, const DebandReport& deband, bool stored) {
    return {counts.luma, counts.invalid, deband, counts.implausible, stored, {}};
}

// `options` with the no-data value as take_heights() meets it: that of the options, or else that of the picture.
// `linear` converts the picture's colours; it may be null.
Result<HeightOptions> with_no_data(const HeightOptions& options, const PictureFacts& facts, const HeightSource& source,
                                   const LinearRows* linear);

// Reads row j of a picture as heights, cleaned and inverted as the options say, but neither filled nor blurred.
HeightCounts take_heights(const Image& image, const HeightSource& source, const HeightOptions& options, int j,
                          float* out);

// Says in a sentence what is wrong: `invalid` texels of the picture are invalid, the first one at (column, row).
Error invalid_heights(std::int64_t invalid, int column, int row, Extent extent, const HeightOptions& options);

}  // namespace tex::inline v1
