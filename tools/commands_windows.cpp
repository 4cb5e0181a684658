// SPDX-License-Identifier: Apache-2.0

#include "cli/process.h"
#include "cli/programs.h"

// What main() is elsewhere (main.cpp), for the command `name`.
extern "C" __declspec(dllexport) int tex_command(const char* name) {
    tex::cli::ProcessHost host;
    const tex::cli::Arguments given = tex::cli::own_arguments(0, nullptr);
    const tex::cli::ProgramRow* const program = tex::cli::find_program(name);
    if (program == nullptr) return static_cast<int>(tex::cli::ExitCode::bug);
    tex::cli::ProcessHost::end(tex::cli::run(*program, given.subspan(given.empty() ? 0 : 1), host));
}
