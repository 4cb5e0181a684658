// SPDX-License-Identifier: Apache-2.0
// bake_stream.h: bake_file() row by row.

#pragma once

#include <memory>
#include <string>

#include <tex/pipeline.h>

#include "files/input_file.h"
#include "formats/row_source.h"
#include "stream/row_stream.h"

namespace tex {

// Whether bake_file() can write what it makes of the picture `rows` in `file` strip by strip.
bool can_stream(const InputFile& file, const RowSource& rows, Container container, const BakeFileOptions& options);

// `rows` is opened once more where its last rows are needed first. Precondition: can_stream(). May throw
// std::bad_alloc.
Result<BakeFileReport> bake_stream(InputFile& file, std::unique_ptr<RowSource> rows, const std::string& output,
                                   Container container, const BakeFileOptions& options, const Execution& execution,
                                   const StreamSizes& sizes = {});

}  // namespace tex
