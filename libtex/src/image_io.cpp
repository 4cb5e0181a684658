// SPDX-License-Identifier: Apache-2.0

#include <tex/file.h>

#include "files/input_file.h"
#include "formats/row_source.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {

Result<Image> read_image(const std::string& path, const ReadOptions& options) {
    return no_throw([&]() -> Result<Image> {
        Result<InputFile> file = open_input(path, options);
        if (!file) return std::move(file).error();
        return read_image(*file, options);
    });
}

Result<Image> read_image(std::span<const std::byte> bytes, const std::string& name, const ReadOptions& options) {
    return no_throw([&]() -> Result<Image> {
        Result<InputFile> file = InputFile::from_memory(name, {bytes.begin(), bytes.end()});
        if (!file) return std::move(file).error();
        return read_image(*file, options);
    });
}

}  // namespace tex::inline v1
