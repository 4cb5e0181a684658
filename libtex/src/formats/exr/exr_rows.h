// SPDX-License-Identifier: Apache-2.0
// exr_rows.h: the rows of an EXR file: scanlines, or tiles side by side.

#pragma once

#include <memory>
#include <vector>

#include <tex/image_io.h>
#include <tex/result.h>
#include <tex/texture.h>

#include "files/input_file.h"
#include "formats/row_source.h"

namespace tex {

// Opens the first part of an EXR, its largest level, to be read as read_exr() would, a few rows at a time; several
// threads may decode at once. `file` must outlive the rows. Errors: those of read_exr() that the header tells.
Result<std::unique_ptr<RowSource>> open_exr_rows(InputFile& file, const ReadOptions& options);

// The same of a texture: the levels and channels that read_exr_texture() takes.
struct ExrTextureRows {
    std::vector<std::unique_ptr<RowSource>> levels;
    Texture head;  // what read_exr_texture() makes of the file, but for its levels
};
Result<ExrTextureRows> open_exr_texture_rows(InputFile& file, const ReadOptions& options);

}  // namespace tex
