// SPDX-License-Identifier: Apache-2.0
// reader_here.h: a decoder in this process, on systems where it does not run in one of its own.

#pragma once

#include <functional>

#include "formats/reader/reader_child.h"

namespace tex::inline v1 {

// Does what tex-reader does, in this thread: the answer is in job.result. `progress` is called for each strip of rows.
// Returns false if it ends without an answer. (tools/reader defines it.)
bool read_here(const ReaderJob& job, const ReaderLimits& limits, const std::function<void()>& progress);

}  // namespace tex::inline v1
