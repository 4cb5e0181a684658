// SPDX-License-Identifier: Apache-2.0
// process_posix.h: what POSIX systems know about a process, each in its own way.

#pragma once

namespace tex::cli {

// The name by which the program was called, without its folder.
[[nodiscard]] const char* program_name();

// Keeps freed memory for the next file, up to 32 MB at the end of each heap. By default, glibc gives it back
// after each file, and the system clears it again for the next one. Large blocks are still given back at once.
void keep_freed_memory();

}  // namespace tex::cli
