// SPDX-License-Identifier: Apache-2.0
// color.h: converts rows of a picture from a colour space to linear values.

#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <tex/image.h>
#include <tex/result.h>

namespace tex {

// A row each of R, G and B. For a grey picture, one is the actual row; the others are copies whose values are not read.
struct ColorRows {
    float* row[3] = {};
    int given = 3;
};
using ConvertRow = std::function<void(const ColorRows& rows, int width)>;

// What color_files() returns. May throw std::bad_alloc.
Result<std::vector<std::string>> files_of_conversion(const std::string& config, const std::string& space);

class LinearRows {
public:
    // Makes the conversion from a colour space for pictures with these channels and samples: see ColorOptions. May
    // throw std::bad_alloc. Errors: those of to_linear().
    static Result<LinearRows> make(const std::vector<std::string>& names, SampleKind sample, int bits,
                                   const std::string& config, const std::string& space);

    // Converts rows 0 to count - 1 of an image, as to_linear() does. Several threads may call at once. May throw
    // std::bad_alloc. Errors: bad_data.
    [[nodiscard]] Result<void> convert(Image& image, int count) const;

private:
    std::string config_;
    std::vector<std::size_t> planes_;  // the planes that hold colour: three or one
    ConvertRow convert_;
};

}  // namespace tex
