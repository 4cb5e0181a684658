// SPDX-License-Identifier: Apache-2.0
// bil_header.h: what the header of a BIL file says.

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <tex/file.h>
#include <tex/types.h>

#include "formats/raw/raw_rows.h"

namespace tex::inline v1 {

// Reads the text of a header. `is_float`: the file is called .flt. `file_bytes`: the size of the file that it is about,
// which tells the number of bits if the text does not. Errors: as open_bil(); they name `path`. May throw
// std::bad_alloc.
Result<RawTexels> read_bil_header(const std::vector<std::byte>& text, const std::string& path, bool is_float,
                                  std::int64_t file_bytes, const ReadOptions& options);

}  // namespace tex::inline v1
