// SPDX-License-Identifier: Apache-2.0
// process.h: the process as a host: its standard streams and signals.
//
// The first SIGINT, SIGTERM or SIGHUP asks the running verbs to stop, so that nothing is left half-written. The command
// then ends by that signal, and a shell sees 128+n. The command ends at once if it does not stop within a second
// (because it is blocked in a read from a terminal, or waits for a decoder that hangs), or if it gets a second signal.
// An unfinished output then has no name, or the handler itself removes its temporary name.

#pragma once

#include "cli/command.h"
#include "cli/exit_code.h"
#include "cli/host.h"

namespace tex::cli {

// The arguments of main(), the name of the program first: UTF-8 on Windows, and any bytes elsewhere.
[[nodiscard]] Arguments own_arguments(int argc, char** argv);

class ProcessHost : public Host {
public:
    // Makes the streams safe to use, and ignores SIGPIPE and SIGXFSZ. A closed pipe and a limit on the size of files
    // are then errors of write().
    ProcessHost();

    [[nodiscard]] bool write_out(std::string_view text) override;
    void write_err(std::string_view text) override;
    [[nodiscard]] bool out_is_terminal() const override;
    [[nodiscard]] bool out_is_abandoned() const override;
    [[nodiscard]] bool err_is_terminal() const override;  // not if TERM is "dumb"
    [[nodiscard]] bool err_has_color() const override;    // a terminal, and NO_COLOR is not set (https://no-color.org)
    void begin() override;
    [[nodiscard]] std::string_view interruption() const override;
    void end_interrupted() override;  // by the signal: does not return

    // Ends the process. Runs no destructors of static objects: a thread that TBB is just starting may need them.
    [[noreturn]] static void end(ExitCode code);
};

}  // namespace tex::cli
