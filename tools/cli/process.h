// SPDX-License-Identifier: Apache-2.0
// process.h: the process as a host: its standard streams and signals.
//
// The first SIGINT, SIGTERM or SIGHUP asks the running verbs to stop, so that nothing is left half-written; the command
// then ends by that signal, and a shell sees 128+n. A command that does not stop within a second (blocked in a read
// from a terminal, or waiting for a decoder that hangs), or that gets a second signal, is ended at once: an unfinished
// output has no name, or the handler itself removes its temporary name.

#pragma once

#include "cli/host.h"

namespace tex::cli {

class ProcessHost : public Host {
public:
    // Makes the streams safe to use, and ignores SIGPIPE and SIGXFSZ: a reader that went away and a limit on the size
    // of files are errors of write().
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
};

}  // namespace tex::cli
