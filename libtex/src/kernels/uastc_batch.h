// SPDX-License-Identifier: Apache-2.0
// uastc_batch.h: many blocks of UASTC that are encoded together, so that those with the same mode fill vectors.

#pragma once

#include <cstddef>
#include <cstdint>

#include <tex/pack.h>

#include "blocks/uastc_write.h"
#include "kernels/block_tries.h"
#include "kernels/uastc_fit.h"
#include "kernels/uastc_hints.h"

namespace tex::inline v1 {

// What an effort spends.
struct UastcEffort {
    Effort effort;
    int planes;   // ways of two planes that a block is fitted to
    float worth;  // lines are tried if their guesses are below this times the error in two planes
    UastcSearch search;
    int kept;  // the best of all are improved
    int rounds;
    bool pairs;
    int solves[2];  // of two planes: when they are found, and when they are improved
    int finals;     // so many of the improved ones are compared as BC1, too
};
[[nodiscard]] UastcEffort uastc_effort(Effort effort);

class UastcBatch : public BlockTries<3> {
public:
    // Takes memory.
    explicit UastcBatch(const UastcEffort& effort);
    [[nodiscard]] static std::size_t memory(const UastcEffort& effort);

    // Encodes the first `count` blocks.
    void encode(int count, std::byte* blocks);

private:
    void add_tries(int block, int lane);
    void fit(int first, int end, const Bc7Steps& steps);
    [[nodiscard]] UastcContent content_of(const Try& found) const;
    UastcContent gather(const Try& found, int lane);
    void gather_ends(const UastcContent& content, int lane);
    void choose(int count);
    void write(int count, std::byte* blocks);
    bool write_solid(int block, std::byte* to);

    struct Chosen {
        Try found;
        Indices indices;
        float first, cost;  // the least error; with that as BC1, what is chosen
    };

    const UastcEffort effort_;
    WorkingVector<Try> ranked_;  // the improved ones of each block, the best one first
    WorkingVector<Chosen> chosen_;
    UastcGuesses guesses_;
    UastcHintGroup hints_;
};

}  // namespace tex::inline v1
