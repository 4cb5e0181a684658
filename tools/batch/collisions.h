// SPDX-License-Identifier: Apache-2.0
// collisions.h: files that must not be the same.

#pragma once

#include <string>
#include <vector>

namespace tex::cli {

struct Task;

// Throws UsageError if two tasks would write one file, or if an output or the depfile is an input or the `list`
// of inputs (empty: there is none): by name, through symbolic and hard links, or as the file behind standard input or
// output. Pipes, FIFOs and devices do not count.
void check_collisions(const std::vector<Task>& tasks, const std::string& depfile, const std::string& list);

// A file that an option names.
struct NamedFile {
    std::string option;
    std::string path;
};

// Throws UsageError if `document`, which is going to be written, is not the name of a file, is an input, or is one
// of `others`, files that the run reads or writes as well (those without a name do not count).
void check_document(const NamedFile& document, const std::vector<std::string>& inputs,
                    const std::vector<NamedFile>& others);

// Throws UsageError if an input is standard input: `option` reads inputs a second time.
void check_read_twice(const std::string& option, const std::vector<std::string>& inputs);

}  // namespace tex::cli
