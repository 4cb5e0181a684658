// SPDX-License-Identifier: Apache-2.0
// bc7_batch.h: many blocks of BC7 that are encoded together, so that those with the same mode fill vectors.

#pragma once

#include <cstddef>
#include <cstdint>

#include <tex/pack.h>

#include "blocks/bc7_write.h"
#include "kernels/bc7_guess.h"
#include "kernels/block_tries.h"

namespace tex::inline v1 {

// What an effort spends.
struct Bc7Effort {
    int planes;    // ways of two planes that a block is fitted to
    float within;  // unless their guesses are above this times the best one
    float worth;   // lines are tried if their guesses are below this times the error in two planes
    Bc7Search search;
    int kept;  // the best of all are improved
    int rounds;
    bool pairs;
};
[[nodiscard]] Bc7Effort bc7_effort(Effort effort);

class Bc7Batch : public BlockTries<4> {
public:
    // Takes memory. `exchanges`: blocks are written with alpha in red and red in alpha.
    explicit Bc7Batch(const Bc7Effort& effort, bool exchanges = false);
    [[nodiscard]] static std::size_t memory(const Bc7Effort& effort);

    // Encodes the first `count` blocks, whose fourth channel is alpha from 0 to 1; block k goes to blocks[k].
    // `has_alpha`: the alphas of each are not all 1.
    void encode(int count, bool has_alpha, std::byte* const* blocks);

private:
    void add_guesses(int block, int lane);
    void add_lines(int block, int lane);
    void fit(int first, int end, const Bc7Steps& steps);
    void finish_alpha(const Try& found, Bc7Content& content) const;
    void write(const Try& found, std::byte* block) const;

    const Bc7Effort effort_;
    const bool exchanges_;
    bool has_alpha_ = false;
    float apart_[kMost][3];  // the error of alpha in a plane of its own
    Bc7Guesses guesses_;
};

}  // namespace tex::inline v1
