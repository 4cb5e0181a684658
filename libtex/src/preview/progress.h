// SPDX-License-Identifier: Apache-2.0
// progress.h: combines the progress of several steps.

#pragma once

#include <tex/execution.h>

namespace tex::render {

// The execution of a step whose progress takes the part of the whole from `from` to `to`. `whole` must outlive the
// result.
inline Execution part(const Execution& whole, double from, double to) {
    Execution step;
    step.threads = whole.threads;
    if (whole.progress)
        step.progress = [&whole, from, to](double done) { return whole.progress(from + (to - from) * done); };
    return step;
}

}  // namespace tex::render
