// SPDX-License-Identifier: Apache-2.0
// stream.h: standard output and standard error.

#pragma once

#include <string_view>

#include "cli/exit_code.h"

namespace tex::cli {

// Opens /dev/null in the wrong direction for each of the three streams that is closed, so that no file that
// we open becomes standard output by accident; reading or writing such a stream then fails. Ignores
// SIGPIPE and SIGXFSZ: a reader that went away and a limit on the size of files are errors of write().
void secure_streams();

// Writes all of `text` to standard output, unbuffered. False where that failed (errno says why).
[[nodiscard]] bool write_stdout(std::string_view text);

// The same, reporting failure: ExitCode::done, or ExitCode::io with a message on stderr. A reader
// that went away gets no message.
[[nodiscard]] ExitCode print(std::string_view text);

// Writes `text` to standard error as one piece; failure is ignored, there is nobody to tell.
void write_stderr(std::string_view text);

// Nobody reads standard output any more.
[[nodiscard]] bool stdout_is_abandoned();

[[nodiscard]] bool stdout_is_terminal();
[[nodiscard]] bool stderr_is_terminal();  // and one that can move its cursor: not TERM=dumb

// Colour on standard error: a terminal, and NO_COLOR not set (https://no-color.org).
[[nodiscard]] bool stderr_has_color();

}  // namespace tex::cli
