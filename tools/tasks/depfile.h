// SPDX-License-Identifier: Apache-2.0
// depfile.h: the files that each output was made from, in the syntax that Make and Ninja read.

#pragma once

#include <string>
#include <vector>

#include <tex/types.h>

namespace tex::cli {

struct Task;

struct Dependency {
    std::vector<std::string> outputs;
    std::vector<std::string> inputs;
};

// Throws UsageError if a task reads or writes a file whose name contains a line feed, which cannot be escaped.
void check_depfile_names(const std::vector<Task>& tasks);

// One rule for each dependency: "out.dds: bricks.png\n". Blanks, #, $, :, % and backslashes are escaped as GNU Make
// requires. (= and ; cannot be escaped: Make cannot handle them, but Ninja can.) Standard input and output are left
// out. Errors: unsupported (a line feed in a name).
[[nodiscard]] Result<std::string> depfile_text(const std::vector<Dependency>& dependencies);

}  // namespace tex::cli
