// SPDX-License-Identifier: Apache-2.0
// reader_zygote.h: one process that is forked for each file, so that OpenImageIO's libraries are loaded once.
//
// Loading them takes a twentieth of a second. The zygote is a tex-reader that has loaded them, has given up what it
// does not need, and waits for requests. It never sees a file: it passes the descriptors of a request to a process that
// it forks for it. That process takes its limits, Landlock and seccomp as a reader does that was started for one file,
// sees that file and no other, and ends. So a crash still costs one file. (All readers of one zygote have the same
// layout of memory, and so the same addresses.)
//
// Who ends whom:
//
//   * The readers are the zygote's children. It alone signals and collects them, so their ids are never those of
//     strangers. It ends a reader when the caller shuts down the socket of the request, or is gone.
//   * The kernel kills the readers if the zygote ends (PR_SET_PDEATHSIG).
//   * The zygote ends when its requests end: libtex has closed the socket, or its process is gone. In case another
//     process has inherited the socket, it also asks the kernel to report the end of its parent.
//   * libtex kills and collects a zygote that does not answer, after the last of its children.
//
// What fails costs time, but no file: if the zygote is gone before it has forked, it is started once more; if that
// fails too, or if it cannot fork, the program is started for the one file. If the zygote is killed while its children
// read, their files fail with an error that says so. A zygote that has failed twice in a row, before it forked even
// once, is not tried again.
//
// The zygote begins with the second file that a process reads or writes: a process that needs a single reader gets that
// one, and is left with no other process afterwards.

#pragma once

#include <string>

#include "formats/reader/reader_child.h"

namespace tex {

// Lets the zygote of this program fork a reader. No child if the program has to be started: for the first job, to
// describe itself, or if there can be no zygote.
ReaderChild fork_reader(const std::string& program, const ReaderJob& job, int progress, const ReaderLimits& limits);

// The id of the zygote; -1 if there is none.
pid_t zygote_id();

}  // namespace tex
