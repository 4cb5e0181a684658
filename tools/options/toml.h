// SPDX-License-Identifier: Apache-2.0
// toml.h: toml++, for the sources that read TOML.
//
// toml++ 3.3 asserts a condition that a file can violate (a table whose name begins with a colon); in release builds it
// assumes the condition. Here a violation is an error in the file.

#pragma once

namespace tex::cli {
struct BrokenToml {};
[[noreturn]] inline void refuse_toml() { throw BrokenToml(); }
}  // namespace tex::cli

#pragma push_macro("NDEBUG")
#undef NDEBUG
#define TOML_ASSERT(condition) ((condition) ? static_cast<void>(0) : tex::cli::refuse_toml())
#include <toml++/toml.h>
#pragma pop_macro("NDEBUG")
