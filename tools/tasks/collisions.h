// SPDX-License-Identifier: Apache-2.0
// collisions.h: finds files that must be different but are the same.

#pragma once

#include <string>
#include <vector>

namespace tex::cli {

struct Task;

// A file that an option names.
struct NamedFile {
    std::string option;
    std::string path;
};

// Throws UsageError if two tasks would write the same file, or if an output or the depfile is an input or one of the
// `lists` that inputs were read from. Files are compared by name, through symbolic and hard links, and as the file
// behind standard input or output. Pipes, FIFOs and devices do not count. With `in_place`, the output of a task may
// have the name of its input.
void check_collisions(const std::vector<Task>& tasks, const std::string& depfile, const std::vector<NamedFile>& lists,
                      bool in_place = false);

// Throws UsageError if `document`, which the run writes, is not the name of a file, is an input, or is one of `others`.
// `others` are the other files that the run reads or writes; entries without a name do not count.
void check_document(const NamedFile& document, const std::vector<std::string>& inputs,
                    const std::vector<NamedFile>& others);

// Throws UsageError if an input is standard input, because `option` reads the inputs a second time.
void check_read_twice(const std::string& option, const std::vector<std::string>& inputs);

}  // namespace tex::cli
