// SPDX-License-Identifier: Apache-2.0
// file_values.h: decides whether the values of a picture are the numbers that its file stores, or fractions of the
// range of their type (ReadOptions::values). Everything that reads pictures, whole or by rows, comes here.

#pragma once

#include <memory>

#include <tex/file.h>

#include "formats/row_source.h"

namespace tex::inline v1 {

// Returns the rows with the values that are wanted. Call this before rows are stored. Throws std::bad_alloc.
std::unique_ptr<RowSource> with_values(std::unique_ptr<RowSource> rows, FileValues values);

}  // namespace tex::inline v1
