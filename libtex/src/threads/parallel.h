// SPDX-License-Identifier: Apache-2.0
// parallel.h: loops over strips, on as many threads as an Execution allows.

#pragma once

#include <algorithm>
#include <type_traits>
#include <utility>

#include <tex/types.h>

namespace tex::inline v1 {

// The part of a verb's progress that one loop covers. A verb that runs several loops gives each loop its share.
struct ProgressSpan {
    double from = 0.0;
    double to = 1.0;
};

// Rows that a loop over a whole map gives to a thread at a time.
inline constexpr int kRowsPerPiece = 16;
// Texels at a time, for loops over levels, whose rows may be short.
inline constexpr int kPieceTexels = 1 << 15;

// The rows of `extent` that hold about kPieceTexels texels: at least 1.
inline int rows_per_piece(Extent extent) { return std::max(1, kPieceTexels / extent.width); }

// The body of a loop, which the caller keeps. (A std::function would allocate memory for most.)
class LoopBody {
public:
    template <class Body>
    requires(!std::is_same_v<std::remove_cvref_t<Body>, LoopBody>) LoopBody(Body&& body)
        : body_(const_cast<void*>(static_cast<const void*>(&body))),
          call_([](void* of, int begin, int end) { (*static_cast<std::remove_reference_t<Body>*>(of))(begin, end); }) {}

    void operator()(int begin, int end) const { call_(body_, begin, end); }

private:
    void* body_;
    void (*call_)(void* body, int begin, int end);
};

// Calls body(begin, end) for consecutive pieces [begin, end) of [0, count), each of `grain` indices (the last may be
// shorter), on up to execution.threads threads. Pieces are the same for every number of threads, so a body
// whose result depends on its piece alone gives the same bytes everywhere. The body may throw std::bad_alloc.
//
// Errors: cancelled, out_of_memory.
Result<void> parallel_for(const Execution& execution, int count, int grain, const LoopBody& body,
                          ProgressSpan span = {});

// The part of an execution between two fractions of its progress. A verb that runs with it reports 0 to 1. `execution`
// must outlive it.
Execution part_of(const Execution& execution, double from, double to);

// The number of threads that `execution` requests: at least 1.
int thread_count(const Execution& execution);

}  // namespace tex::inline v1
