// SPDX-License-Identifier: Apache-2.0
// rdo_runs.h: passes of rate-distortion optimisation over the blocks of a band, in the order of the file. Each part of
// the band (rdo_parts.h) has a budget, and a lambda for each run of its blocks; what blocks copy may be in any part.
// How blocks are chosen differs: rdo_pass.h, rdo_copy_pass.h.

#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include <tex/types.h>

#include "rows/rdo_budget.h"
#include "rows/rdo_rate.h"

namespace tex::inline v1 {

struct RdoPart {
    int blocks = 0;
    double texels = 0.0;        // in the level
    double plain_sum = 0.0;     // the sum of the angles without optimisation, in degrees
    double improved_sum = 0.0;  // the same of what a lambda of 0 writes
};

// What all bands have.
struct RdoBlocks {
    Extent block{4, 4};
    int block_texels = 16;
    int window = 0;                // bytes
    std::vector<std::byte> plain;  // 16 bytes a block
    std::vector<int> part_of;      // of each block
    std::vector<RdoPart> parts;

    [[nodiscard]] std::size_t count() const { return plain.size() / 16; }
    [[nodiscard]] RdoPart& part(std::size_t index) { return parts[static_cast<std::size_t>(part_of[index])]; }
    void set_parts(std::vector<int> of_blocks);
};

struct RdoResult {
    std::vector<std::byte> blocks;
    ByteCounts literals{};
    std::vector<double> growths;  // of each part's sum of angles, in degrees, from RdoPart::improved_sum
    double most_raised = 0.0;     // see RdoAngles
    bool is_whole = false;        // unless the pass stopped early
};

// How a part is sampled: one of `stride` runs, at one lambda.
struct RdoSampled {
    float lambda;
    int stride;  // 0: none of its runs
};

struct RdoSample {
    std::vector<std::vector<double>> growths;  // of each part, one for each sampled run
    ByteCounts literals{};
};

class RdoRuns {
public:
    explicit RdoRuns(const RdoBlocks& band);
    virtual ~RdoRuns() = default;

    // Optimises all blocks, with a budget for each part. Blocks for which it has nothing left are kept. If `may_stop`
    // is set, it returns as soon as the budgets of half of the blocks have wandered. Throws std::bad_alloc.
    RdoResult run(std::vector<RdoBudget>& budgets, bool may_stop);
    // Optimises a sample of each part; the other blocks are kept. Lambda is in degrees for each bit.
    RdoSample sample(const std::vector<RdoSampled>& parts);

protected:
    virtual void set_lambda(float lambda) = 0;
    // Writes the best bytes of the next block into `result_`, or keeps it if it may not spend() their growth.
    virtual void choose_block(int block) = 0;
    // Writes what a lambda of 0 writes.
    virtual void keep_block(int block) = 0;
    // Takes the growth of a block from the budget of its part, or of each part. Returns false if too little is left.
    [[nodiscard]] bool spend(int block, double growth);
    [[nodiscard]] bool spend(const std::vector<double>& growths);

    RdoResult result_;

private:
    [[nodiscard]] bool may_spend(std::size_t part, double growth) const {
        return budgets_ == nullptr || (*budgets_)[part].allows(result_.growths[part] + growth);
    }

    const RdoBlocks& all_;
    std::vector<RdoBudget>* budgets_ = nullptr;
};

// Whether the parts that have wandered hold half of the blocks of a band.
[[nodiscard]] bool is_half(const RdoBlocks& band, const std::vector<bool>& parts);

// Makes a pass whose literals are expected to be like these.
using RdoMakeRuns = std::function<std::unique_ptr<RdoRuns>(const ByteCounts& literals)>;

}  // namespace tex::inline v1
