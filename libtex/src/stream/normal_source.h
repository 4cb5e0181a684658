// SPDX-License-Identifier: Apache-2.0
// normal_source.h: reads the normals of a whole map into memory.

#pragma once

#include <tex/file.h>

#include "stream/map_source.h"

namespace tex::inline v1 {

// Does what read_normals(path) does, for a map from any source. May throw std::bad_alloc.
Result<Source> read_normals(MapSource& map, const SourceOptions& options, bool base_only, const Execution& execution);

}  // namespace tex::inline v1
