// SPDX-License-Identifier: Apache-2.0

#include <tex/image_io.h>

#include "files/input_file.h"
#include "formats/row_source.h"
#include "threads/guard.h"

namespace tex {

Result<Image> read_image(const std::string& path, const ReadOptions& options) {
    return guarded([&]() -> Result<Image> {
        Result<InputFile> file = open_input(path, options);
        if (!file) return std::move(file).error();
        return read_image(*file, options);
    });
}

}  // namespace tex
