// SPDX-License-Identifier: Apache-2.0
// batch.h: commands that take many inputs. They run one job for each input on several threads and report in the order
// of the inputs.
//
// A run plans (it decides which input becomes which output), checks the plan, processes each task and finishes. A
// failure does not stop the other files. The exit code is the highest of all files.

#pragma once

#include <vector>

#include "batch/job.h"
#include "batch/plan.h"
#include "cli/programs.h"
#include "options/files.h"
#include "options/output.h"
#include "options/run.h"

namespace tex::cli {

// A command that only reads its inputs (FileOptions::add_inputs). Its tasks have no output.
class Batch : public Program {
public:
    using Program::Program;

    FileOptions files;
    RunOptions running;

    [[nodiscard]] ExitCode work(Console& console) override;

protected:
    [[nodiscard]] virtual Result<std::vector<Task>> plan() const;

    // Checks the plan before anything is written. Throws UsageError; returns other errors.
    [[nodiscard]] virtual Result<void> check(const std::vector<Task>&) { return {}; }

    // Processes one task. Called from several threads at once.
    [[nodiscard]] virtual Result<void> process(Job& job) = 0;

    // Called once at the end, for results that concern the whole run.
    [[nodiscard]] virtual ExitCode finish(Console&) { return ExitCode::done; }

private:
    [[nodiscard]] ExitCode run_tasks(const std::vector<Task>& tasks, Console& console);
};

// A command that makes one output from each input (FileOptions::add).
class Converter : public Batch {
public:
    using Batch::Batch;

    OutputOptions output;

protected:
    [[nodiscard]] virtual OutputRules rules() const { return {}; }
    [[nodiscard]] Result<std::vector<Task>> plan() const override;
};

}  // namespace tex::cli
