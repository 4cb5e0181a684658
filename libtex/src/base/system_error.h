// SPDX-License-Identifier: Apache-2.0
// system_error.h: what the system said, as an Error.

#pragma once

#include <string>

#include <tex/result.h>

namespace tex {

// The message of errno value `number`, as a clause: "no such file or directory". Thread-safe, the same in every locale.
std::string system_reason(int number);

// An Error for `file`: out_of_memory where the system ran out of memory or descriptors (ENOMEM, EMFILE, ENFILE), else io. `doing` comes first in the
// reason where it is not empty: "cannot be renamed: permission denied".
Error system_error(const std::string& file, int number, const char* doing = "");

}  // namespace tex
