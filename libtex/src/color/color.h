// SPDX-License-Identifier: Apache-2.0
// color.h: colour spaces of height maps. The folder color/ alone knows OpenColorIO.

#pragma once

#include <string>
#include <vector>

#include <tex/types.h>

#include "rows/linear_rows.h"

namespace tex::inline v1 {

// What color_files() returns. May throw std::bad_alloc.
Result<std::vector<std::string>> files_of_conversion(const std::string& config, const std::string& space);

// The conversion from a colour space for pictures with these channels and samples: see ColorOptions. May throw
// std::bad_alloc. Errors: those of to_linear().
Result<LinearRows> linear_rows(const std::vector<std::string>& names, SampleKind sample, int bits,
                               const std::string& config, const std::string& space);

}  // namespace tex::inline v1
