// SPDX-License-Identifier: Apache-2.0
// normal_source.h: reads the normals of an open file or another source.

#pragma once

#include <tex/source.h>

#include "files/input_file.h"
#include "stream/map_source.h"

namespace tex {

// Does what read_normals(path) does. May throw std::bad_alloc.
Result<Source> read_normals(InputFile& file, const SourceOptions& options, bool base_only, const Execution& execution);

// The same for a map from another source.
Result<Source> read_normals(MapSource& map, const SourceOptions& options, bool base_only, const Execution& execution);

}  // namespace tex
