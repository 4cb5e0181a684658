// SPDX-License-Identifier: Apache-2.0
// Replaces sandbox_linux.cpp and landlock_linux.cpp in a build without restrictions (TEX_SANDBOX=OFF): the limits of
// limits_posix.cpp alone apply.

#include "reader.h"

namespace tex::reader {

void end_with_parent() {}

int landlock_version() { return 0; }

bool restrict_files() { return false; }

bool filter_calls() { return false; }

}  // namespace tex::reader
