// SPDX-License-Identifier: Apache-2.0
// flow_plan.h: the tasks of a flow: what each makes, and what it waits for.
//
// A task makes one strip of one stage. It waits for the strips that it needs, and, if its stage is in order, for the
// one before it: in the order in which reading lets them be made, so that a strip at the top of a texture that repeats,
// which waits for the last rows, does not keep the others.

#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "stream/stage.h"

namespace tex::inline v1 {

class FlowPlan {
public:
    // The tasks of a stage, which are numbered from `first`.
    struct Line {
        Stage* stage;
        int first = 0;
        int count = 0;
        bool is_target = false;  // nothing needs its strips
        std::vector<int> ready;  // a heap: the topmost strip comes first

        [[nodiscard]] int row_of(int task) const { return stage->begin() + (task - first) * stage->strip_rows_; }
        [[nodiscard]] int rows_of(int task) const {
            return std::min(stage->strip_rows_, stage->extent().height - row_of(task));
        }
        [[nodiscard]] std::int64_t texels_of(int task) const {
            return static_cast<std::int64_t>(stage->extent().width) * rows_of(task);
        }
    };
    // A task of a target, which can be done when so many strips have been read.
    struct Due {
        int reads = 0;
        int task = 0;
        std::int64_t texels = 0;
        bool is_done = false;
    };

    // Strips have about `texels` texels, and consist of `together` rows or a multiple.
    FlowPlan(const std::vector<std::unique_ptr<Stage>>& stages, int texels, int together);

    [[nodiscard]] int tasks() const { return static_cast<int>(waits.size()); }
    [[nodiscard]] std::size_t line_of(int task) const;
    // The tasks that wait for a task, and those whose strips it needs.
    [[nodiscard]] std::span<const int> after(int task) const { return part(after_, after_begin_, task); }
    [[nodiscard]] std::span<const int> before(int task) const { return part(before_, before_begin_, task); }

    std::vector<Line> lines;
    std::vector<int> waits;          // for how many others each task waits
    std::vector<int> users;          // how many tasks need its strip
    std::vector<Due> due;            // what the targets can do, in its order
    std::vector<int> due_of;         // for each task of a target: its index there
    std::int64_t strip_texels = 0;   // of the largest strip that is read
    std::int64_t target_texels = 0;  // of all targets

private:
    using Pairs = std::vector<std::pair<int, int>>;

    static std::span<const int> part(const std::vector<int>& all, const std::vector<int>& begin, int task) {
        const auto k = static_cast<std::size_t>(task);
        return std::span(all).subspan(static_cast<std::size_t>(begin[k]),
                                      static_cast<std::size_t>(begin[k + 1] - begin[k]));
    }
    void divide(const std::vector<std::unique_ptr<Stage>>& stages, int texels, int together);
    void plan_reading();
    void link();
    void link_before(const Line& line, int task);
    void link_in_order(const Line& line, Pairs& pairs) const;
    void link_after(const Pairs& pairs);
    void plan_writing();

    std::vector<int> after_begin_, after_;
    std::vector<int> before_begin_, before_;
    std::vector<int> reads_of_;  // for each task: how many strips must have been read before it can be done
};

}  // namespace tex::inline v1
