// SPDX-License-Identifier: Apache-2.0

#include "cli/programs.h"

#include <algorithm>
#include <exception>
#include <new>
#include <system_error>

#include <fmt/format.h>

#include "cli/usage_error.h"

namespace tex::cli {
namespace {

// Filled before main() begins; only read after that.
std::vector<ProgramRow>& table() {
    static std::vector<ProgramRow> rows;
    return rows;
}

}  // namespace

const std::vector<ProgramRow>& programs() { return table(); }

const ProgramRow* find_program(std::string_view name) {
    const auto row = std::find_if(programs().begin(), programs().end(),
                                  [name](const ProgramRow& candidate) { return candidate.name == name; });
    return row == programs().end() ? nullptr : &*row;
}

void register_program(const ProgramRow& row) {
    const auto place =
        std::find_if(table().begin(), table().end(), [&](const ProgramRow& other) { return other.name > row.name; });
    table().insert(place, row);
}

ExitCode run(const ProgramRow& program, Arguments arguments, Host& host) {
    Console console(program.name, host);
    try {
        const std::unique_ptr<Program> self = program.make(program);
        if (const auto ended = self->command.parse(arguments, console)) return *ended;
        return self->work(console);
    } catch (const UsageError& error) {
        console.error(error.what());
        return ExitCode::usage;
    } catch (const std::bad_alloc&) {
        console.error("out of memory");
        return ExitCode::io;
    } catch (const std::system_error& error) {
        console.error(error.what());
        return ExitCode::io;
    } catch (const std::exception& error) {
        console.error(fmt::format("{}; {}", error.what(), kBugReport));
    } catch (...) {
        console.error(kBugReport);
    }
    return ExitCode::bug;
}

}  // namespace tex::cli
