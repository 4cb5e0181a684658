// SPDX-License-Identifier: Apache-2.0
// collisions.h: files that must not be the same.

#pragma once

#include <string>
#include <vector>

namespace tex::cli {

struct Task;

// Throws UsageError where two tasks would write one file, or where an output or the depfile is an input: by
// name, or through symbolic and hard links. Streams, FIFOs and devices are nobody's file.
void check_collisions(const std::vector<Task>& tasks, const std::string& depfile);

}  // namespace tex::cli
