// SPDX-License-Identifier: Apache-2.0
// bake_stream.h: bake_file() row by row.

#pragma once

#include <string>

#include <tex/pipeline.h>

#include "files/input_file.h"
#include "stream/flow.h"

namespace tex::inline v1 {

// Does what bake_file() does, for a file that is open already. May throw std::bad_alloc.
Result<BakeFileReport> bake_stream(InputFile& file, const std::string& output, Container container,
                                   const BakeFileOptions& options, const Execution& execution,
                                   const StreamSizes& sizes = {});

}  // namespace tex::inline v1
