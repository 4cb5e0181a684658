// SPDX-License-Identifier: Apache-2.0
// bake_stream.h: bake_file() row by row.

#pragma once

#include <string>

#include <tex/pipeline.h>

#include "containers/row_source.h"
#include "pipeline/row_stream.h"

namespace tex {

// Precondition: rows.is_sequential(); `container` is dds or ktx2; neither a colour space nor fill_invalid. May throw std::bad_alloc.
Result<BakeFileReport> bake_stream(RowSource& rows, const std::string& input, const std::string& output, Container container,
                                   const BakeFileOptions& options, const Execution& execution,
                                   const StreamSizes& sizes = {});

}  // namespace tex
