// SPDX-License-Identifier: Apache-2.0

#include "rows/rdo_runs.h"

#include <algorithm>
#include <utility>

namespace tex::inline v1 {

void RdoBlocks::set_parts(std::vector<int> of_blocks) {
    part_of = std::move(of_blocks);
    parts.resize(static_cast<std::size_t>(*std::max_element(part_of.begin(), part_of.end())) + 1);
    for (std::size_t index = 0; index < part_of.size(); ++index) ++part(index).blocks;
}

bool is_half(const RdoBlocks& band, const std::vector<bool>& parts) {
    std::size_t blocks = 0;
    for (std::size_t part = 0; part < parts.size(); ++part)
        blocks += parts[part] ? static_cast<std::size_t>(band.parts[part].blocks) : 0;
    return 2 * blocks >= band.count();
}

RdoRuns::RdoRuns(const RdoBlocks& band) : all_(band) {
    result_.blocks.resize(16 * band.count());
    result_.growths.resize(band.parts.size());
}

bool RdoRuns::spend(int block, double growth) {
    const auto part = static_cast<std::size_t>(all_.part_of[static_cast<std::size_t>(block)]);
    if (!may_spend(part, growth)) return false;
    result_.growths[part] += growth;
    return true;
}

bool RdoRuns::spend(const std::vector<double>& growths) {
    for (std::size_t part = 0; part < growths.size(); ++part) {
        if (growths[part] > 0.0 && !may_spend(part, growths[part])) return false;
    }
    for (std::size_t part = 0; part < growths.size(); ++part) result_.growths[part] += growths[part];
    return true;
}

RdoResult RdoRuns::run(std::vector<RdoBudget>& budgets, bool may_stop) {
    budgets_ = &budgets;
    std::vector<float> lambdas(budgets.size());
    std::vector<int> done(budgets.size());
    std::vector<bool> wandered(budgets.size());
    int last = -1;
    for (std::size_t block = 0; block < all_.count(); ++block) {
        const int here = all_.part_of[block];
        const auto part = static_cast<std::size_t>(here);
        const bool begins_run = done[part]++ % kRdoRun == 0;
        if (begins_run) {
            lambdas[part] = budgets[part].next(result_.growths[part]);
            if (budgets[part].has_wandered()) wandered[part] = true;
            if (may_stop && wandered[part] && is_half(all_, wandered)) return std::move(result_);
        }
        if (begins_run || here != last) set_lambda(lambdas[part]);
        last = here;
        choose_block(static_cast<int>(block));
    }
    result_.is_whole = true;
    return std::move(result_);
}

RdoSample RdoRuns::sample(const std::vector<RdoSampled>& parts) {
    RdoSample sample;
    sample.growths.resize(parts.size());
    std::vector<int> done(parts.size());
    std::vector<double> before(parts.size());
    ByteCounts literals{};
    int last = -1;
    bool counts = true;
    for (std::size_t block = 0; block < all_.count(); ++block) {
        const int here = all_.part_of[block];
        const auto part = static_cast<std::size_t>(here);
        const int number = done[part]++, stride = parts[part].stride;
        const bool is_taken = stride > 0 && is_sampled(number / kRdoRun, stride);
        // The literals of blocks that are kept do not count: what optimised runs write is another choice of bytes.
        if (!is_taken && counts) literals = result_.literals;
        if (is_taken && !counts) result_.literals = literals;
        counts = is_taken;
        if (is_taken && here != last) set_lambda(parts[part].lambda);
        if (is_taken) last = here;
        if (is_taken && number % kRdoRun == 0) before[part] = result_.growths[part];
        is_taken ? choose_block(static_cast<int>(block)) : keep_block(static_cast<int>(block));
        const bool ends_run = number % kRdoRun == kRdoRun - 1 || done[part] == all_.parts[part].blocks;
        if (is_taken && ends_run) sample.growths[part].push_back(result_.growths[part] - before[part]);
    }
    sample.literals = counts ? result_.literals : literals;
    return sample;
}

}  // namespace tex::inline v1
