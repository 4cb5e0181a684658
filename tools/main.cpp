// SPDX-License-Identifier: Apache-2.0
// main() of every command. build-normals has all commands; the others have their own. In a static build (TEX_STATIC),
// which has one program for all, TEX_COMMAND is empty: the name by which the program was called tells which to run.

#include <cstdio>
#include <string_view>

#include "cli/exit_code.h"
#include "cli/process.h"
#include "cli/programs.h"

namespace {

std::string_view wanted(std::string_view called) {
    const std::string_view fixed = TEX_COMMAND;
    return fixed.empty() ? called.substr(called.rfind('/') + 1) : fixed;  // npos + 1 is 0
}

}  // namespace

int main(int argc, char** argv) {
    tex::cli::ProcessHost host;
    const tex::cli::Arguments given = tex::cli::own_arguments(argc, argv);
    const tex::cli::ProgramRow* const program = tex::cli::find_program(wanted(given.empty() ? "" : given.front()));
    if (program == nullptr) {
        std::fputs("libtex: error: this program acts by its name: call it bake-normals, or as another command\n",
                   stderr);
        return static_cast<int>(tex::cli::ExitCode::usage);
    }
    tex::cli::ProcessHost::end(tex::cli::run(*program, given.subspan(given.empty() ? 0 : 1), host));
}
