// SPDX-License-Identifier: Apache-2.0
// png_exif.h: the orientation that a PNG states in its eXIf chunk (PNG 1.5.0 extensions, 2017).

#pragma once

#include <string_view>

#include <tex/types.h>

#include "files/input_file.h"

namespace tex::inline v1 {

// The orientation in the content of an eXIf chunk, 1 to 8; 1 if there is none.
[[nodiscard]] int png_orientation(std::string_view content);

// The orientation of an eXIf chunk after the texels, where ImageMagick puts it: in the last 64 KiB of the file.
// Precondition: the file's size is known. Throws std::bad_alloc. Errors: io.
[[nodiscard]] Result<int> png_orientation_at_end(const InputFile& file);

}  // namespace tex::inline v1
