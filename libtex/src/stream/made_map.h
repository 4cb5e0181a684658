// SPDX-License-Identifier: Apache-2.0
// made_map.h: maps that steps make, as sources for the step after them.

#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <tex/pipeline.h>

#include "stream/map_source.h"

namespace tex::inline v1 {

// The map that `steps` make of the file `input`, all of which must outlive the map. Precondition: there is a step.
std::unique_ptr<MapSource> made_map(const std::string& input, const std::vector<Step>& steps, std::size_t count,
                                    const Execution& execution);

}  // namespace tex::inline v1
