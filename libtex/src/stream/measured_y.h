// SPDX-License-Identifier: Apache-2.0
// measured_y.h: what SourceOptions::measure_y says if the texels do not show where y points.

#pragma once

#include <string>

#include <tex/types.h>

namespace tex::inline v1 {

[[nodiscard]] inline Error undecided_y(const std::string& path) {
    return {ErrorCode::bad_data, path,
            "which way green points does not show clearly in the texels; say up or down instead of "
            "measured"};
}

}  // namespace tex::inline v1
