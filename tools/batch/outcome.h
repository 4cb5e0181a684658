// SPDX-License-Identifier: Apache-2.0
// outcome.h: what became of each file, printed in the order of the inputs whatever the order in which they end.

#pragma once

#include <algorithm>
#include <atomic>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <tex/result.h>

#include "batch/depfile.h"
#include "cli/console.h"
#include "cli/exit_code.h"
#include "reports/json.h"

namespace tex::cli {

// What became of one file.
struct Outcome {  // NOLINT(bugprone-exception-escape): reads into the noexcept constructor of a null Json, which throws
                  // for other values
    std::string input;
    std::optional<Error> error;
    bool is_bug = false;      // the error is ours
    bool is_silent = false;   // the error is not worth a message
    bool has_levels = false;  // one output for each level
    Json report;
    std::string text;                // for standard output, unless --json is given
    ExitCode code = ExitCode::done;  // what the command found, beside `error`
    std::vector<std::string> warnings;
    std::vector<std::string> outputs;
    std::vector<std::string> prerequisites;
};

class Reporter {
public:
    Reporter(Console& console, std::size_t count, bool json) : console_(console), waiting_(count), json_(json) {}

    // The outcome of the file at `place`. Prints it, and those that waited for it: errors and warnings on standard
    // error, with --json a line on standard output. Any thread may call.
    void finish(std::size_t place, Outcome outcome);

    // Standard output cannot be written any more: the run may stop.
    [[nodiscard]] bool is_abandoned() const { return is_abandoned_; }

    // After all calls of finish().
    [[nodiscard]] ExitCode exit_code() const { return exit_code_; }
    [[nodiscard]] std::size_t done() const { return done_; }
    [[nodiscard]] const std::vector<Dependency>& dependencies() const { return dependencies_; }

private:
    void report(const Outcome& outcome);
    [[nodiscard]] static std::string json_line(const Outcome& outcome);
    void print_result(const std::string& text);
    void raise(ExitCode code) { exit_code_ = std::max(exit_code_, code); }

    Console& console_;
    std::mutex mutex_;
    std::vector<std::optional<Outcome>> waiting_;
    std::size_t reported_ = 0;
    std::size_t done_ = 0;
    bool json_;
    std::atomic<bool> is_abandoned_{false};
    ExitCode exit_code_ = ExitCode::done;
    std::vector<Dependency> dependencies_;
};

}  // namespace tex::cli
