// SPDX-License-Identifier: Apache-2.0
// repack.h: the step of commands that read one normal map and write it, and what bake-normals shares with them.

#pragma once

#include <functional>

#include <tex/pipeline.h>

#include "batch/job.h"
#include "options/output.h"
#include "options/source.h"

namespace tex::cli {

// The encoding where the user names none.
using EncodingOf = std::function<Encoding(const SourceInfo& source)>;

// pack_file() of the job's input, and what there is to tell of it. `options` says what happens on the way (level,
// scale, mip); all else is `source`'s and `output`'s. `also_tell` comes last, where all went well.
[[nodiscard]] Result<void> repack(Job& job, SourceOptions& source, const OutputOptions& output, PackFileOptions options,
                                  const EncodingOf& encoding,
                                  const std::function<void(const PackFileReport&)>& also_tell = {});

// The names of files that each hold a level, where `name` has {level}, else empty.
[[nodiscard]] LevelNames level_names(const std::string& name);

// Tells the job that `name`, of so many levels, has been written.
void wrote_levels(Job& job, const std::string& name, int levels);

}  // namespace tex::cli
