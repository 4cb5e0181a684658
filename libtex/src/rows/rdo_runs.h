// SPDX-License-Identifier: Apache-2.0
// rdo_runs.h: passes of rate-distortion optimisation over the blocks of a band, in runs that share a lambda. How blocks
// are chosen differs: rdo_pass.h, rdo_astc_pass.h.

#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "rows/rdo_budget.h"
#include "rows/rdo_rate.h"

namespace tex::inline v1 {

// What all bands have.
struct RdoBlocks {
    int block_texels = 16;
    std::vector<std::byte> plain;  // 16 bytes a block
    double texels = 0.0;           // in the level
    double plain_sum = 0.0;        // the sum of the angles of `plain`, in degrees
    double improved_sum = 0.0;     // the same of what a lambda of 0 writes

    [[nodiscard]] std::size_t count() const { return plain.size() / 16; }
};

struct RdoResult {
    std::vector<std::byte> blocks;
    ByteCounts literals{};
    double growth = 0.0;       // of the sum of angles, in degrees, from RdoBlocks::improved_sum
    double most_raised = 0.0;  // see RdoAngles
    bool is_whole = false;     // unless the pass stopped early
};

struct RdoSample {
    std::vector<double> growths;  // one for each sampled run
    ByteCounts literals{};
};

class RdoRuns {
public:
    explicit RdoRuns(std::size_t blocks) : count_(static_cast<int>(blocks)) { result_.blocks.resize(16 * blocks); }
    virtual ~RdoRuns() = default;

    // Optimises all blocks. Those for which the budget has nothing left are kept. If `may_stop` is set, it returns as
    // soon as the budget has wandered. Throws std::bad_alloc.
    RdoResult run(RdoBudget& budget, bool may_stop);
    // Optimises one of `stride` runs of blocks, at one lambda, in degrees for each bit; the others are kept.
    RdoSample sample(float lambda, int stride);

protected:
    virtual void set_lambda(float lambda) = 0;
    // Writes the best bytes of the next block into `result_`, or keeps it if the budget, if there is one, has too
    // little left.
    virtual void choose_block(int block, const RdoBudget* budget) = 0;
    // Writes what a lambda of 0 writes.
    virtual void keep_block(int block) = 0;

    RdoResult result_;

private:
    const int count_;
};

// Makes a pass whose literals are expected to be like these.
using RdoMakeRuns = std::function<std::unique_ptr<RdoRuns>(const ByteCounts& literals)>;

}  // namespace tex::inline v1
