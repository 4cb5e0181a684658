// SPDX-License-Identifier: Apache-2.0
// Works row by row; rows/linear_rows.h converts.

#include <tex/height.h>

#include <utility>

#include "color/color.h"
#include "color/ocio.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {

const char* opencolorio_version() { return ocio_version(); }

Result<Image> to_linear(Image image, const ColorOptions& options) {
    return no_throw([&]() -> Result<Image> {
        const Result<LinearRows> rows =
            linear_rows(image.names, image.sample, image.bits, options.config, options.space);
        if (!rows) return rows.error();
        if (image.no_data) {
            Image texel;
            texel.names = image.names;
            for (std::size_t k = 0; k < image.names.size(); ++k)
                texel.planes.emplace_back(Extent{1, 1}, *image.no_data);
            if (Result<void> converted = rows->convert(texel, 1); !converted) return converted.error();
            image.no_data = texel.planes.front().at(0, 0);
        }
        if (Result<void> converted = rows->convert(image, image.extent().height); !converted) return converted.error();
        image.ground.reset();  // what a transfer curve has bent is in no unit
        image.ground_remark.clear();
        return std::move(image);
    });
}

Result<std::vector<std::string>> color_files(const ColorOptions& options) {
    return no_throw([&] { return files_of_conversion(options.config, options.space); });
}

}  // namespace tex::inline v1
