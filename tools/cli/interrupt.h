// SPDX-License-Identifier: Apache-2.0
// interrupt.h: SIGINT, SIGTERM and SIGHUP. The first one asks the running verbs to stop, so that nothing is
// left half-written; the command then ends by that signal, and a shell sees 128+n. Who does not stop within
// a second (blocked in a read of a terminal, or in a wait for a decoder that hangs), or is asked twice, is ended at
// once: an output that is not whole is nameless, or its temporary name is removed by the handler itself.

#pragma once

namespace tex::cli {

void catch_signals();

// The signal that came, or 0.
[[nodiscard]] int caught_signal();

// Ends the process by `signal`, as if it had never been caught. Leaves no temporary file behind, whatever other threads
// do.
[[noreturn]] void end_by_signal(int signal);

}  // namespace tex::cli
