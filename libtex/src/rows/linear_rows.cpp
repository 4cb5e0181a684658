// SPDX-License-Identifier: Apache-2.0

#include "rows/linear_rows.h"

#include <algorithm>

namespace tex::inline v1 {

Result<void> LinearRows::convert(Image& image, int count) const {
    const int width = image.extent().width;
    ColorRows rows{{}, static_cast<int>(planes_.size())};
    Plane<float> copies;  // copies of a grey row
    if (rows.given == 1) copies = Plane<float>(Extent{width, 2});
    for (int j = 0; j < count; ++j) {
        for (int k = 0; k < rows.given; ++k) rows.row[k] = image.planes[planes_[static_cast<std::size_t>(k)]].row(j);
        for (int k = rows.given; k < 3; ++k) {
            rows.row[k] = copies.row(k - 1);
            std::copy_n(rows.row[0], width, rows.row[k]);
        }
        if (Result<void> converted = convert_(rows, width); !converted) return converted;
    }
    return {};
}

}  // namespace tex::inline v1
