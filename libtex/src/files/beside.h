// SPDX-License-Identifier: Apache-2.0
// beside.h: files that another file names.

#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <tex/types.h>

namespace tex::inline v1 {

// The path of a file that the file at `path` names by a relative path.
std::string beside(const std::string& path, const std::string& name);

// Fails for what exists and is not a regular file. A reader of a FIFO would wait, and a device has no end: a file from
// a stranger must not choose them. Errors: io.
Result<void> check_regular(const std::string& path);

// Errors: those of InputFile::open() and read_rest(); unsupported (more than `most` bytes).
Result<std::vector<std::byte>> read_at_most(const std::string& path, std::int64_t most);

// Reads a file that the file at `path` names. Errors: those of check_regular() and read_at_most().
Result<std::vector<std::byte>> read_beside(const std::string& path, const std::string& name, std::int64_t most);

// Does that, and an error says which file names the one that it is about.
Result<std::vector<std::byte>> read_named(const std::string& path, const std::string& name, std::int64_t most);

}  // namespace tex::inline v1
