// SPDX-License-Identifier: Apache-2.0
// uastc_xy_batch.h: many blocks of UASTC of x and y that are encoded together. See uastc_batch.h.

#pragma once

#include <cstddef>

#include <tex/pack.h>

#include "blocks/uastc_write.h"
#include "kernels/block_tries.h"
#include "kernels/uastc_xy_fit.h"

namespace tex::inline v1 {

// What an effort spends.
struct UastcXyEffort {
    Effort effort;
    int parts;  // patterns of two subsets that are tried
    int kept;   // the best of all are improved
    int rounds;
    bool pairs;
    int solves[2];  // when endpoints are found, and when they are improved
};
[[nodiscard]] UastcXyEffort uastc_xy_effort(Effort effort);

class UastcXyBatch : public BlockTries<3> {
public:
    // Takes memory.
    explicit UastcXyBatch(const UastcXyEffort& effort);
    [[nodiscard]] static std::size_t memory(const UastcXyEffort& effort);

    // Encodes the first `count` blocks.
    void encode(int count, std::byte* blocks);

private:
    void add_tries(int block, int lane);
    void fit(const Bc7Steps& steps);
    [[nodiscard]] UastcContent content_of(const Try& found) const;

    const UastcXyEffort effort_;
    UastcXyGuesses guesses_;
};

}  // namespace tex::inline v1
