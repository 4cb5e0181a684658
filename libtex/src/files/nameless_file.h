// SPDX-License-Identifier: Apache-2.0
// nameless_file.h: files without names, which Linux has. Elsewhere, files have temporary names instead.
//
// Functions that fail set errno.

#pragma once

#include <cstdint>
#include <string>

#include "files/descriptor.h"

namespace tex::inline v1 {

// Flags for opening a folder in which files are created: with O_PATH it need not be readable.
int folder_flags();

// Opens a file without a name in an open folder, for writing; `mode` is that of open(). None and ENOTSUP if this system
// or file system does not have such files, or could not give it a name later.
Descriptor open_nameless(int folder, unsigned mode);
// Gives it a name that does not exist.
bool give_name(int fd, int folder, const std::string& name);

// A path by which this process can open an open file. Of an empty text, if there is none.
std::string path_of_open(int fd);

// Renames a file in an open folder to a name that does not exist. False and ENOSYS if that cannot be had in one step.
bool rename_to_new(int folder, const char* from, const char* to);

// temporary_file(), or a file in memory if the folder takes none.
Descriptor scratch_file(const std::string& folder);

// A file in memory, as far as the system has such files, that other processes may enlarge and fill, but not shorten.
Descriptor file_in_memory();

// Gives pages that nothing reads any more back to the system: from the one that holds `begin` to the one before `end`,
// but none with one of the first `kept` bytes.
void release_pages(int fd, std::uint64_t begin, std::uint64_t end, std::uint64_t kept);

}  // namespace tex::inline v1
