// SPDX-License-Identifier: Apache-2.0
// blend_stream.h: blend_file() row by row.

#pragma once

#include <string>

#include <tex/pipeline.h>

#include "stream/flow.h"
#include "stream/map_source.h"

namespace tex::inline v1 {

// Does what blend_file() does. May throw std::bad_alloc.
Result<BlendFileReport> blend_stream(const std::string& input, const std::string& output, Container container,
                                     const BlendFileOptions& options, const Execution& execution,
                                     const StreamSizes& sizes = {});

// Blends onto a base from any source.
Result<BlendFileReport> blend_stream(MapSource& base, const std::string& output, Container container,
                                     const BlendFileOptions& options, const Execution& execution,
                                     const StreamSizes& sizes = {});

}  // namespace tex::inline v1
