// SPDX-License-Identifier: Apache-2.0
// median.h: the middle of measured values.

#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tex::inline v1 {

// The median, the upper one of two; 0 without values. Changes the order of `values`.
inline double median(std::vector<double>& values) {
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace tex::inline v1
