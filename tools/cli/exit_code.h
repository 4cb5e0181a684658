// SPDX-License-Identifier: Apache-2.0
// exit_code.h: the meaning of a command's exit status. The help and the man pages show this table.

#pragma once

#include <tex/types.h>

namespace tex::cli {

enum class ExitCode { done = 0, findings = 1, usage = 2, io = 3, data = 4, bug = 5 };

inline constexpr Named<ExitCode> kExitCodeNames[] = {
    {ExitCode::done, "0", "done"},
    {ExitCode::findings, "1", "a check found problems, or a limit was exceeded"},
    {ExitCode::usage, "2", "the command line is wrong; nothing was read or written"},
    {ExitCode::io, "3", "a file cannot be opened, read or written; out of memory, disk or threads"},
    {ExitCode::data, "4", "a file is damaged, of an unsupported type, or does not fit the options"},
    {ExitCode::bug, "5", "a bug in this program"},
};

inline constexpr const char* kBugReport =
    "this is a bug: please report it with the command line and, if you can, the file";

// The exit code of a failure that happens while files are processed. (bad_option then concerns the file; for example,
// the file lacks the requested channel.) A command that a signal cancels ends by that signal; see process.h.
constexpr ExitCode exit_code(ErrorCode code) {
    switch (code) {
        case ErrorCode::io:
        case ErrorCode::out_of_memory:
        case ErrorCode::cancelled: return ExitCode::io;
        case ErrorCode::bad_data:
        case ErrorCode::unsupported:
        case ErrorCode::bad_option: return ExitCode::data;
    }
    return ExitCode::bug;
}

}  // namespace tex::cli
