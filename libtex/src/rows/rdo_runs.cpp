// SPDX-License-Identifier: Apache-2.0

#include "rows/rdo_runs.h"

#include <algorithm>
#include <utility>

namespace tex::inline v1 {

RdoResult RdoRuns::run(RdoBudget& budget, bool may_stop) {
    for (int block = 0; block < count_; ++block) {
        if (block % kRdoRun == 0) {
            set_lambda(budget.next(result_.growth));
            if (may_stop && budget.has_wandered()) return std::move(result_);
        }
        choose_block(block, &budget);
    }
    result_.is_whole = true;
    return std::move(result_);
}

RdoSample RdoRuns::sample(float lambda, int stride) {
    set_lambda(lambda);
    RdoSample sample;
    for (int first = 0; first < count_; first += kRdoRun) {
        const int end = std::min(count_, first + kRdoRun);
        const double before = result_.growth;
        const ByteCounts literals = result_.literals;
        const bool is_taken = is_sampled(first / kRdoRun, stride);
        for (int block = first; block < end; ++block) is_taken ? choose_block(block, nullptr) : keep_block(block);
        if (is_taken) {
            sample.growths.push_back(result_.growth - before);
        } else {
            result_.literals = literals;  // what optimised runs write is another choice of bytes
        }
    }
    sample.literals = result_.literals;
    return sample;
}

}  // namespace tex::inline v1
