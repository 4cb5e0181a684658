// SPDX-License-Identifier: Apache-2.0
// up_to_date.h: what --update skips. It remembers nothing from run to run, so the times of the file system decide.

#pragma once

#include <cstdint>
#include <optional>

#include "tasks/task.h"

namespace tex::cli {

// The time at which a file was last changed, in nanoseconds: the later one of mtime and ctime. Copying programs may set
// mtime back, and none can set ctime. This is the latest time of the files that the task reads; nothing if one of them
// is not a regular file.
[[nodiscard]] std::optional<std::int64_t> latest_change(const Task& task);

// Whether all outputs are regular files with contents, whose mtimes are later than `change`. Outputs with a file for
// each level never are, because it is not known how many there must be.
[[nodiscard]] bool is_up_to_date(const Task& task, std::int64_t change);

// Makes the outputs look as old as `change`, so that they are made again.
void make_outdated(const Task& task, std::int64_t change);

}  // namespace tex::cli
