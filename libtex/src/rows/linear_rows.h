// SPDX-License-Identifier: Apache-2.0
// linear_rows.h: converts rows of a picture from a colour space to linear values, by what color/color.h makes.

#pragma once

#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include <tex/types.h>

namespace tex::inline v1 {

// A row each of R, G and B. For a grey picture, one is the actual row; the others are copies whose values are not read.
struct ColorRows {
    float* row[3] = {};
    int given = 3;
};
// Several threads may call at once. Errors: bad_data.
using ConvertRow = std::function<Result<void>(const ColorRows& rows, int width)>;

class LinearRows {
public:
    // `planes` of an image hold its colours: three or one.
    LinearRows(std::vector<std::size_t> planes, ConvertRow convert)
        : planes_(std::move(planes)), convert_(std::move(convert)) {}

    // Converts rows 0 to count - 1 of an image, as to_linear() does. Several threads may call at once. May throw
    // std::bad_alloc. Errors: bad_data.
    [[nodiscard]] Result<void> convert(Image& image, int count) const;

private:
    std::vector<std::size_t> planes_;
    ConvertRow convert_;
};

}  // namespace tex::inline v1
