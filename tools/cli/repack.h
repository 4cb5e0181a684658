// SPDX-License-Identifier: Apache-2.0
// repack.h: the step of commands that read one normal map and write it, and what bake-normals shares with them.

#pragma once

#include <functional>

#include <tex/pipeline.h>

#include "cli/job.h"
#include "cli/output.h"
#include "cli/source.h"

namespace tex::cli {

// The encoding where the user names none.
using EncodingOf = std::function<Encoding(const SourceInfo& source)>;

// pack_file() of the job's input, and what there is to tell of it. `options` says what happens on the way (level, scale, mip); all else is
// `source`'s and `output`'s.
[[nodiscard]] Result<void> repack(Job& job, SourceOptions& source, const OutputOptions& output, PackFileOptions options,
                                  const EncodingOf& encoding);

// The names of the task's files where each level has one of its own, else empty.
[[nodiscard]] LevelNames level_names(const Task& task);

// Tells the job that its output, of so many levels, has been written.
void wrote_levels(Job& job, int levels);

// Tells the job's report which way the file went.
void report_path(Job& job, Path path);

}  // namespace tex::cli
