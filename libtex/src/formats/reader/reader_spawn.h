// SPDX-License-Identifier: Apache-2.0
// reader_spawn.h: starts the reader program.

#pragma once

#include <span>
#include <string>
#include <vector>

#include <spawn.h>
#include <sys/types.h>

namespace tex::inline v1 {

// Starts the program in a new process group, with default signals and without an environment. Its standard streams are
// /dev/null. The descriptors get the numbers from kFirstDescriptor on, and the program has no others. Because of the
// process group, Ctrl-C at the terminal reaches only the caller, and any process that the reader starts ends with the
// reader. Returns 0 or an errno.
int spawn_reader(const std::string& program, std::vector<std::string> arguments, std::span<const int> descriptors,
                 pid_t& child);

// The path of the binary that contains this code.
std::string own_binary();

// Make the new program close every descriptor from `first` on: by an action, or by a flag of posix_spawn().
int close_others(posix_spawn_file_actions_t& actions, int first);
short flags_that_close_others();

}  // namespace tex::inline v1
