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

// Throws UsageError where `path`, the value of `option`, is not the name of a file, is an input, or is one of `others`, files that the run reads or writes
// as well (empty names do not count). Inputs must be files: the option reads them a second time.
void check_document(const std::string& option, const std::string& path, const std::vector<std::string>& inputs,
                    const std::vector<std::string>& others);

}  // namespace tex::cli
