// SPDX-License-Identifier: Apache-2.0
// level_rows.h: reads the rows of a level of a DDS or KTX2 file from their place in the file.

#pragma once

#include <memory>

#include "files/input_file.h"
#include "formats/row_source.h"
#include "formats/stored_texture.h"

namespace tex::inline v1 {

// Reads bytes of a file, which must outlive the function. May throw std::bad_alloc. Errors: io, bad_data.
[[nodiscard]] FetchBytes fetch_from(const InputFile& file);

// Opens level k. Several threads may read rows at once, whole rows of blocks at a time. The stored values are those
// that decode() gives. The file must outlive the rows. Precondition: the size of the file is known.
std::unique_ptr<RowSource> open_level_rows(const InputFile& file, std::shared_ptr<const StoredTexture> texture,
                                           std::size_t k);

}  // namespace tex::inline v1
