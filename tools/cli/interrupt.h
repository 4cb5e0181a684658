// SPDX-License-Identifier: Apache-2.0
// interrupt.h: SIGINT, SIGTERM and SIGHUP. The first one asks the running verbs to stop, so that nothing is
// left half-written; the command then ends by that signal, and a shell sees 128+n. Who does not stop within
// a second (blocked in a read of a terminal, say), or is asked twice, is ended at once: outputs are
// nameless until they are whole, so that is safe as well.

#pragma once

namespace tex::cli {

void catch_signals();

// The signal that came, or 0.
[[nodiscard]] int caught_signal();

// Ends the process by `signal`, as if it had never been caught.
[[noreturn]] void end_by_signal(int signal);

}  // namespace tex::cli
