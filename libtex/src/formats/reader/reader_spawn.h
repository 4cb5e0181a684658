// SPDX-License-Identifier: Apache-2.0
// reader_spawn.h: starts the reader program.

#pragma once

#include <span>
#include <string>
#include <vector>

#include <sys/types.h>

namespace tex {

// Starts the program with these descriptors as number kFirstDescriptor and those that follow, with /dev/null as its
// standard streams and no other descriptor, with no environment and default signals, and as the leader of its own
// process group. A Ctrl-C at the terminal therefore reaches only the caller, and any process that the reader has
// started ends with the reader. Returns 0 or an errno.
int spawn_reader(const std::string& program, std::vector<std::string> arguments, std::span<const int> descriptors,
                 pid_t& child);

}  // namespace tex
