// SPDX-License-Identifier: Apache-2.0
// ocio.h: colour spaces of OpenColorIO's configurations. In a build without OpenColorIO (TEX_OCIO=OFF), ocio_off.cpp
// replaces ocio.cpp.

#pragma once

#include <string>
#include <vector>

#include <tex/types.h>

#include "rows/linear_rows.h"

namespace tex::inline v1 {

// Empty in a build without OpenColorIO.
const char* ocio_version();

// The conversion from `space` to the role scene_linear. Errors: those of to_linear(); unsupported (a build without
// OpenColorIO).
Result<ConvertRow> by_config(const std::string& file, const std::string& space);

// The configuration `file` and the tables that it uses for `space`. Errors: as by_config().
Result<std::vector<std::string>> files_of_config(const std::string& file, const std::string& space);

}  // namespace tex::inline v1
