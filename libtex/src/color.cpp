// SPDX-License-Identifier: Apache-2.0
// Works row by row; rows/color.cpp converts.

#include <tex/color.h>

#include "rows/color.h"
#include "threads/guard.h"

namespace tex {

Result<void> to_linear(Image& image, const ColorOptions& options) {
    return guarded([&]() -> Result<void> {
        const Result<LinearRows> rows =
            LinearRows::make(image.names, image.sample, image.bits, options.config, options.space);
        if (!rows) return rows.error();
        return rows->convert(image, image.extent().height);
    });
}

}  // namespace tex
