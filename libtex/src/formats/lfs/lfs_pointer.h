// SPDX-License-Identifier: Apache-2.0
// lfs_pointer.h: files that Git LFS has not fetched. A small text is in their place, which other readers would call
// damaged.

#pragma once

#include <memory>
#include <string_view>

#include <tex/file.h>
#include <tex/types.h>

#include "files/input_file.h"
#include "formats/row_source.h"

namespace tex::inline v1 {

inline constexpr std::string_view kLfsMagic = "version https://git-lfs.github.com/spec/";

// Errors: bad_data, always: the reason says what the file is, and which command fetches the real one.
Result<std::unique_ptr<RowSource>> refuse_lfs_pointer(InputFile& file, const ReadOptions& options);

}  // namespace tex::inline v1
