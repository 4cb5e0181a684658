// SPDX-License-Identifier: Apache-2.0
// depfile.h: what each output was made from, in the syntax that Make and Ninja read.

#pragma once

#include <string>
#include <vector>

namespace tex::cli {

struct Dependency {
    std::vector<std::string> outputs;
    std::vector<std::string> inputs;
};

// One rule for each dependency: "out.dds: bricks.png\n". Blanks, #, $, :, % and backslashes are escaped as
// GNU Make wants it. A line feed has no escape: names that hold one are left out. (Nor have = and ;, with
// which Make cannot cope, but Ninja can.)
[[nodiscard]] std::string depfile_text(const std::vector<Dependency>& dependencies);

}  // namespace tex::cli
