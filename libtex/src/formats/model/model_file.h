// SPDX-License-Identifier: Apache-2.0
// model_file.h: glTF models in place of pictures. They hold pictures, but most commands take only those.

#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include <tex/file.h>
#include <tex/types.h>

#include "files/input_file.h"
#include "formats/row_source.h"

namespace tex::inline v1 {

// Whether a file begins as GLB, or as JSON does. No picture begins with a brace.
bool may_be_model(std::span<const std::byte> head);

// Errors: unsupported, always: the reason says what the file is, and which commands read it.
Result<std::unique_ptr<RowSource>> refuse_model(InputFile& file, const ReadOptions& options);

}  // namespace tex::inline v1
