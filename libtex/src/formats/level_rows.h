// SPDX-License-Identifier: Apache-2.0
// level_rows.h: the rows of a level of a DDS or KTX2 file, read where they stand.

#pragma once

#include <memory>

#include "files/input_file.h"
#include "formats/row_source.h"
#include "formats/stored_texture.h"

namespace tex {

// Level k. Rows may be read by several threads at once, rows of blocks at a time; they are stored as decode() would
// decode them. The file must outlive the rows. Precondition: the size of the file is known.
std::unique_ptr<RowSource> open_level_rows(const InputFile& file, std::shared_ptr<const StoredTexture> texture,
                                           std::size_t k);

}  // namespace tex
