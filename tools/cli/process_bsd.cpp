// SPDX-License-Identifier: Apache-2.0

#include <cstdlib>

#include "cli/process_posix.h"

namespace tex::cli {

const char* program_name() { return getprogname(); }

void keep_freed_memory() {}

}  // namespace tex::cli
