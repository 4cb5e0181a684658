// SPDX-License-Identifier: Apache-2.0
// reader_spawn.h: starts the reader program.

#pragma once

#include <span>
#include <string>
#include <vector>

#include <sys/types.h>

namespace tex::inline v1 {

// Starts the program in a new process group, with default signals and without an environment. Its standard streams are
// /dev/null. The descriptors get the numbers from kFirstDescriptor on, and the program has no others. Because of the
// process group, Ctrl-C at the terminal reaches only the caller, and any process that the reader starts ends with the
// reader. Returns 0 or an errno.
int spawn_reader(const std::string& program, std::vector<std::string> arguments, std::span<const int> descriptors,
                 pid_t& child);

}  // namespace tex::inline v1
