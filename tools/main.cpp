// SPDX-License-Identifier: Apache-2.0
// main() of every command. build-normals has all commands; the others have their own.

#include <cstddef>

#include "cli/process.h"
#include "cli/programs.h"

int main(int argc, char** argv) {
    tex::cli::ProcessHost host;
    const auto count = static_cast<std::size_t>(argc > 0 ? argc - 1 : 0);
    tex::cli::ProcessHost::end(tex::cli::run(*tex::cli::find_program(TEX_COMMAND), {argv + 1, count}, host));
}
