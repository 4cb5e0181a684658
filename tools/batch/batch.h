// SPDX-License-Identifier: Apache-2.0
// batch.h: the frame of every command: files in, one job for each on several threads, reports out in the
// order of the inputs.

#pragma once

#include <functional>
#include <vector>

#include "batch/files.h"
#include "batch/job.h"
#include "cli/command.h"
#include "options/output.h"

namespace tex::cli {

enum class ShowProgress { automatic, always, never };

inline constexpr Named<ShowProgress> kShowProgressNames[] = {
    {ShowProgress::automatic, "auto", "on a terminal"},
    {ShowProgress::always, "always", "also where standard error is no terminal"},
    {ShowProgress::never, "never", "not at all"},
};

struct RunOptions {
    int threads = Execution{}.threads;
    bool json = false;
    bool quiet = false;
    ShowProgress progress = ShowProgress::automatic;
    ReadOptions read;

    void add(Command& command);
    [[nodiscard]] bool shows_progress() const;
};

// What a command does.
struct Steps {
    OutputDefaults defaults;

    // Looks at the plan, before anything is read or written; throws UsageError, and returns other errors.
    // May be empty.
    std::function<Result<void>(const std::vector<Task>& tasks)> check;

    // Turns one input into its output. Called from several threads at once.
    std::function<Result<void>(Job& job)> process;

    // Called once at the end, for warnings about the run as a whole. May be empty.
    std::function<void()> finish;
};

// Runs the steps over all inputs: plan, check, process, report. A failure does not stop the other files;
// the exit code is the highest. Ends the process by its signal where one came.
[[nodiscard]] ExitCode run_batch(const Command& command, const FileOptions& files, const RunOptions& run,
                                 const OutputOptions& output, const Steps& steps);

// The same for commands that write nothing for each input (FileOptions::add_inputs): tasks have no output.
[[nodiscard]] ExitCode run_readers(const Command& command, const FileOptions& files, const RunOptions& run,
                                   const Steps& steps);

// The frame of main(): streams, signals, and every exception turned into a sentence and an exit code.
[[nodiscard]] int run_main(const char* program, const std::function<ExitCode()>& body);

}  // namespace tex::cli
