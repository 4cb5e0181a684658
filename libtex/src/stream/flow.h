// SPDX-License-Identifier: Apache-2.0
// flow.h: from sources through stages to targets: the one way in which rows move, whether from file to file or between
// the steps of a manifest.
//
// A flow is a graph of stages. Each makes its picture in strips; a strip can be made as soon as all strips exist that
// its stage reaches, and is forgotten when nothing needs it any more. So a flow holds as many rows as its stages ask
// for: a stage that needs all rows makes the flow hold all of them, and the first rows of a texture that repeats, which
// need its last ones, wait for them while everything else goes on. Strips that do not depend on each other are made in
// parallel. The bytes of the outputs do not depend on sizes and threads, because each row is made by one function from
// rows alone.

#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <tex/types.h>

#include "stream/stage.h"

namespace tex::inline v1 {

// How pictures are divided. The bytes of the outputs do not depend on it.
struct StreamSizes {
    int strip_texels = 1 << 15;            // enough to pay for handing a strip over, few enough to stay in a cache
    std::int64_t worth_threads = 1 << 17;  // smaller pictures are done before a second thread could start: they use
    int strip_texels_alone = 1 << 14;      // strips of this size, which stay in the cache of one processor
};

class Flow {
public:
    // Adds a stage after those that it needs.
    template <class S, class... Args>
    S& add(Args&&... args) {
        auto stage = std::make_unique<S>(std::forward<Args>(args)...);
        S& added = *stage;
        stages_.push_back(std::move(stage));
        return added;
    }
    // Strips consist of this many rows, or a multiple: those of targets that encode blocks.
    void set_rows_together(int rows) { rows_together_ = rows; }
    // To be called by a stage that has found that no result can be made.
    void only_count() { only_counts_ = true; }

    // Makes all strips of all stages. Errors: those of the stages, of the topmost row first; those of Stage::check();
    // cancelled, out_of_memory. May throw std::bad_alloc.
    Result<void> run(const Execution& execution, const StreamSizes& sizes = {});

private:
    friend class FlowRun;

    std::vector<std::unique_ptr<Stage>> stages_;
    int rows_together_ = 1;
    std::atomic<bool> only_counts_{false};
};

}  // namespace tex::inline v1
