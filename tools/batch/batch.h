// SPDX-License-Identifier: Apache-2.0
// batch.h: commands that take many inputs. They run one job for each input on several threads and report in the order
// of the inputs.
//
// A run plans (it decides which input becomes which output), checks the plan, processes each task and finishes. A
// failure does not stop the other files. The exit code is the highest of all files.

#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include <tex/pipeline.h>

#include "batch/plan.h"
#include "cli/programs.h"
#include "options/files.h"
#include "options/mips.h"
#include "options/output.h"
#include "options/run.h"
#include "tasks/job.h"
#include "tasks/repeated_warnings.h"

namespace tex::cli {

// The most files that are processed at once, however many processors there are. More threads then speed up each file,
// and memory use stays that of a few textures.
inline constexpr std::size_t kMostFilesAtOnce = 8;

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

    // How many of them may be processed at once.
    [[nodiscard]] virtual std::size_t most_at_once(const std::vector<Task>&) const { return kMostFilesAtOnce; }

    // Called once at the end, for results that concern the whole run.
    [[nodiscard]] virtual ExitCode finish(Console&) { return ExitCode::done; }

    RepeatedWarnings repeated_;  // printed after finish()

private:
    [[nodiscard]] ExitCode run_tasks(const std::vector<Task>& tasks, Console& console);
};

// What was written.
struct OutputFacts {
    Extent extent;  // of the base level
    int levels = 1;
    bool is_reduced = false;  // larger levels are left out, as --max-size says
    Encoding encoding = Encoding::rgb8;
};

// A command that makes one output from each input (FileOptions::add).
class Converter : public Batch {
public:
    using Batch::Batch;

    static constexpr bool kIsStep = true;  // ProgramRow::is_step
    OutputOptions output;

    // For build-normals, which decides itself about inputs and outputs, and joins steps. Command::parse() has read the
    // options.

    // The task that makes `path` from `input`. Throws UsageError if the name does not show the file type, or if the
    // file type cannot hold the format.
    [[nodiscard]] Task task_for(const std::string& input, const std::string& path,
                                const std::string& origin = {}) const {
        Task task{input, path};
        task.origin = origin;
        return task_for(std::move(task));
    }
    // The task, made of one that has more than these.
    [[nodiscard]] Task task_for(Task task) const;
    // The task for a tile of a terrain, with the tiles around it: `pattern` names them (grid.h). Throws also what
    // grid_files() throws; its errors leave the tile alone. Precondition: files.tiles.
    [[nodiscard]] Task task_for_tile(const std::string& input, const std::string& output,
                                     const std::string& pattern) const;
    // Whether outputs with <UDIM> in their names are made for each tile of a mesh, and which tiles it has
    // (OutputRules::tiles).
    [[nodiscard]] bool makes_tiles() const;
    [[nodiscard]] std::vector<int> tiles_of(const std::string& input) const;
    // The output options of such a task. Throws UsageError if --for names several engines.
    [[nodiscard]] OutputOptions output_for_task() const;
    // Does what check() does, for such a task.
    [[nodiscard]] Result<void> check_task(const Task& task) { return check({task}); }
    // Does what process() does, for a job of such a task.
    [[nodiscard]] Result<void> process_task(Job& job);
    // What process() does, as a step of apply_steps(). Nothing if the command does something else.
    [[nodiscard]] virtual std::optional<Step> step(Job&) { return std::nullopt; }
    // An error if the job's input is not what the command takes, such as colours instead of normals. Reads all of it.
    [[nodiscard]] virtual Result<void> accept(const Job&) const { return {}; }
    // Makes a step of this command look for that while it reads the job's input, and then make nothing.
    virtual void add_accept(Step&, const Job&) const {}
    // Prints the warnings that the step's result calls for. Any thread may call this.
    virtual void note(Job&, const StepsReport&) {}
    // Warns of what the output of a job lacks although nobody asked for that: smaller levels, sides that blocks need,
    // the size of --max-size. `about` is the file that is named; empty: the input. Any thread may call this.
    void note_output(Job& job, const OutputFacts& facts, const std::string& about = {});
    // The error with the option that avoids it, if there is one.
    [[nodiscard]] virtual Error with_remedy(const Error& error) const { return error; }
    // Does what finish() does.
    void finish_steps(Console& console) {
        std::ignore = finish(console);
        repeated_.print(console);
    }

protected:
    // The option group of levels, if the command has it.
    [[nodiscard]] virtual const MipChainOptions* mip_chain() const { return nullptr; }
    [[nodiscard]] virtual OutputRules rules() const { return {}; }
    [[nodiscard]] Result<std::vector<Task>> plan() const override;
    // Warns of a job whose input is a model and whose outputs are pictures, unless an option asks for pictures: `what`
    // is said of the input, and how to get the model follows.
    void note_pictures(Job& job, const std::string& what);

private:
    [[nodiscard]] const OutputRules& known_rules() const;

    // rules(), for task_for(): they may come from files.
    mutable std::once_flag rules_are_known_;
    mutable OutputRules known_rules_;
};

}  // namespace tex::cli
