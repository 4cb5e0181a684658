// SPDX-License-Identifier: Apache-2.0
// pack_stream.h: pack_file() row by row.

#pragma once

#include <string>

#include <tex/pipeline.h>

#include "files/input_file.h"
#include "stream/flow.h"
#include "stream/map_source.h"

namespace tex::inline v1 {

// Does what pack_file() does, for a file that is open already and has not been read. May throw std::bad_alloc.
Result<PackFileReport> pack_stream(InputFile& file, const std::string& output, Container container,
                                   const PackFileOptions& options, const Execution& execution,
                                   const StreamSizes& sizes = {});

// Packs a map from any source.
Result<PackFileReport> pack_stream(MapSource& map, const std::string& output, Container container,
                                   const PackFileOptions& options, const Execution& execution,
                                   const StreamSizes& sizes = {});

}  // namespace tex::inline v1
