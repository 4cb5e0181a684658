// SPDX-License-Identifier: Apache-2.0
// process_posix.h: what POSIX systems know about a process, each in its own way.

#pragma once

namespace tex::cli {

// The name by which the program was called, without its folder.
[[nodiscard]] const char* program_name();

// Keeps freed memory for the next step and the next file, up to 1 GB at the end of each heap. By default, glibc gives
// it back, and the system clears it again.
void keep_freed_memory();

}  // namespace tex::cli
