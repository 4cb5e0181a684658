// SPDX-License-Identifier: Apache-2.0
// outcome.h: the result of each file. Results are printed in the order of the inputs, whatever the order in which files
// end.

#pragma once

#include <algorithm>
#include <atomic>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <tex/types.h>

#include "cli/console.h"
#include "cli/exit_code.h"
#include "cli/json.h"
#include "tasks/depfile.h"

namespace tex::cli {

// The result of one file.
struct Outcome {  // NOLINT(bugprone-exception-escape): the tool follows the noexcept constructor of a null Json, which
                  // throws only for other values
    std::string input;
    std::string name;  // of the input in messages
    std::optional<Error> error;
    bool is_bug = false;      // the error is a bug in the program
    bool is_silent = false;   // no message is printed for the error
    bool has_levels = false;  // each level has its own output
    bool is_joint = false;    // `input` is one of several: warnings name the file that they are about, and no other
    Json report;
    std::string text;                   // for standard output, unless --json is given
    ExitCode code = ExitCode::done;     // what the command found, apart from `error`
    std::vector<FileWarning> warnings;  // printed, and in the JSON
    std::vector<FileWarning> remarks;   // in the JSON alone
    float seconds = 0.0f;               // of wall-clock time
    std::vector<std::string> outputs;
    std::vector<std::string> prerequisites;
};

// When outcomes are printed: in the order of the files, or as soon as each file is done.
enum class Printed { in_order, at_once };

class Reporter {
public:
    Reporter(Console& console, std::size_t count, bool json, Printed when = Printed::in_order)
        : console_(console), waiting_(count), json_(json), when_(when) {}

    // Takes the outcome of the file at `place`. Prints it and all later outcomes that were waiting for it: errors and
    // warnings on standard error and, with --json, one line on standard output. Any thread may call this.
    void finish(std::size_t place, Outcome outcome);

    // Prints the outcomes that still wait for others, because the run stopped before those files.
    void report_waiting();

    // True if standard output can no longer be written; the run may then stop.
    [[nodiscard]] bool is_abandoned() const { return is_abandoned_; }

    // Valid after all calls of finish().
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
    Printed when_;
    std::atomic<bool> is_abandoned_{false};
    ExitCode exit_code_ = ExitCode::done;
    std::vector<Dependency> dependencies_;
};

}  // namespace tex::cli
