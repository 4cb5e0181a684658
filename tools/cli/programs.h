// SPDX-License-Identifier: Apache-2.0
// programs.h: a command as an object, and the table of all commands.
//
// main(), tests and any other code call run(), as often as they like and from several threads at once. Each run has its
// own object, which keeps nothing for the next run. Runs share only what belongs to the process: its working directory,
// its environment, TBB's threads (--threads N also limits other runs that work at the same time), and the standard
// input behind "-".
//
// tools/<verb>-normals.cpp ends with the line that adds its command to the table:
//
//     const cli::Registered<BakeNormals> kRegistered("bake-normals", "Turns height maps into normal maps.");

#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/exit_code.h"

namespace tex::cli {

class Program;

// One row of the table.
struct ProgramRow {
    std::string_view name;     // "bake-normals"
    std::string_view summary;  // a sentence
    bool is_step;              // it makes an output from each input, so that a manifest can name it
    std::unique_ptr<Program> (*make)(const ProgramRow& row);
};

// One run of a command. Constructors add the command's options to `command`.
class Program {
public:
    explicit Program(const ProgramRow& row) : command(row.name, row.summary) {}
    virtual ~Program() = default;
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    Command command;

    // Does the work. The options have been read and checked. May throw UsageError before anything is written.
    [[nodiscard]] virtual ExitCode work(Console& console) = 0;
};

// The commands that are linked into this program, sorted by name.
[[nodiscard]] const std::vector<ProgramRow>& programs();

// The row of a command, or null.
[[nodiscard]] const ProgramRow* find_program(std::string_view name);

// Runs a command: parses, checks, works. Turns every exception into a message and an exit code.
[[nodiscard]] ExitCode run(const ProgramRow& program, Arguments arguments, Host& host);

void register_program(const ProgramRow& row);

template <class P>
struct Registered {
    Registered(std::string_view name, std::string_view summary) noexcept {
        constexpr bool kIsStep = requires { requires P::kIsStep; };
        register_program({name, summary, kIsStep,
                          [](const ProgramRow& row) -> std::unique_ptr<Program> { return std::make_unique<P>(row); }});
    }
};

}  // namespace tex::cli
