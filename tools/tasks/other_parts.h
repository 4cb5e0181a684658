// SPDX-License-Identifier: Apache-2.0
// other_parts.h: inputs that consist of several files.

#pragma once

#include <string>
#include <vector>

namespace tex::cli {

// The names of the other files that an input consists of, if they are there: the header of a BIL, BIP, BSQ or GridFloat
// file; the .prj and world files that say where an elevation model lies. `path` leads to the input, `name` is what the
// result is named after.
[[nodiscard]] std::vector<std::string> other_parts(const std::string& name, const std::string& path);

}  // namespace tex::cli
