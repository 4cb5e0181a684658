// SPDX-License-Identifier: Apache-2.0
// usage_error.h: the error for a wrong command line.

#pragma once

#include <stdexcept>
#include <string>

namespace tex::cli {

// Thrown while a command line is parsed and checked, before anything is read or written; what() is one clause
// without a final full stop. The command prints it and ends with ExitCode::usage.
class UsageError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace tex::cli
