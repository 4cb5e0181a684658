// SPDX-License-Identifier: Apache-2.0
// written_levels.h: outputs in one file, or in one file for each level.

#pragma once

#include <cstddef>
#include <string>

#include <tex/file.h>
#include <tex/format.h>
#include <tex/pipeline.h>
#include <tex/types.h>

#include "tasks/job.h"

namespace tex::cli {

// If `name` contains {level}, the names of the files that hold one level each; else empty.
[[nodiscard]] LevelNames level_names(const std::string& name);

// Records that the job has written `name` with this number of levels.
void wrote_levels(Job& job, const std::string& name, int levels);

struct WrittenLevels {
    int levels = 1;
    std::size_t bytes = 0;  // of all files
};

// Writes a texture as the job's output, in one file or in one for each level, and records that. A file type that holds
// one level gets the base level.
[[nodiscard]] Result<WrittenLevels> write_levels(Job& job, Texture texture, const WriteOptions& options);

}  // namespace tex::cli
