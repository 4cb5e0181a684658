// SPDX-License-Identifier: Apache-2.0
// usage_error.h: the error for a wrong command line.

#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace tex::cli {

// Thrown while a command line is parsed and checked, before anything is read or written; what() is one clause
// without a final full stop. The command prints it and ends with ExitCode::usage.
class UsageError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
    // `subject`: the option, such as "--size", or the file that the reason is about; it stands before the reason.
    UsageError(std::string subject, const std::string& reason)
        : std::runtime_error(subject + ": " + reason), subject_(std::move(subject)) {}

    [[nodiscard]] const std::string& subject() const { return subject_; }

private:
    std::string subject_;
};

}  // namespace tex::cli
