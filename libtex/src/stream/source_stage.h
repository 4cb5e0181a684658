// SPDX-License-Identifier: Apache-2.0
// source_stage.h: the rows of a picture in a file, as the first stages of a flow.

#pragma once

#include <functional>
#include <string>

#include "formats/row_source.h"
#include "stream/flow.h"

namespace tex::inline v1 {

// Changes rows 0 to count - 1 of an image. Several threads may call it at once.
using ConvertRows = std::function<Result<void>(Image& rows, int count)>;

// Adds stages that read the rows, and returns the one whose strips hold them as an image. The rows and `input`, their
// name for messages, must outlive the flow. `convert` may be empty.
Stage& add_source(Flow& flow, RowSource& rows, const std::string& input, ConvertRows convert = {});

// Returns `error`, which says that an option does not fit the picture, unless the picture is also damaged: that error
// comes first. Precondition: no row has been decoded yet.
Error after_all_rows(RowSource& rows, const std::string& input, const Error& error);

}  // namespace tex::inline v1
