// SPDX-License-Identifier: Apache-2.0
// bc7_batch.h: many blocks of BC7 that are encoded together, so that those with the same mode fill vectors.

#pragma once

#include <cstddef>
#include <cstdint>

#include <tex/pack.h>

#include "blocks/bc7_write.h"
#include "kernels/bc7_guess.h"
#include "memory/lent_memory.h"

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

class Bc7Batch {
public:
    static constexpr int kMost = 256;  // blocks

    // Takes memory.
    explicit Bc7Batch(const Bc7Effort& effort);
    [[nodiscard]] static std::size_t memory(const Bc7Effort& effort);

    // The texels of a block: x, y, z of a vector, and alpha from 0 to 1, row by row.
    float (*texels(int block))[4] { return texels_[static_cast<std::size_t>(block)].value; }

    // Encodes the first `count` blocks; block k goes to blocks[k]. `has_alpha`: the alphas of each are not all 1.
    void encode(int count, bool has_alpha, std::byte* const* blocks);

private:
    struct Texels {
        float value[16][4];
    };
    // A way to encode a block.
    struct Try {
        float error;
        std::int16_t block;
        std::uint8_t kind, partition;
        std::uint8_t component[3];  // of two planes: the scalar one, and the colours
        std::uint8_t ends[3][2][4];
    };
    // A subset of a try, of which subset 0 is all.
    struct Part {
        int index;  // of the try
        std::uint16_t mask;
        std::uint8_t subset, texels;
    };

    void prepare(int count);
    void guess(int first, int count);
    void add_guesses(int block, int lane);
    void add_lines(int block, int lane);
    void drop_hopeless();
    void sort_parts();
    void fit(int first, int end, const Bc7Steps& steps);
    void gather(const Try& from, const Part& part, int lane);
    void scatter(const Part& part, int lane, bool indices, Try& to);
    void keep(int count);
    void finish_alpha(const Try& found, Bc7Content& content) const;
    void write(const Try& found, std::byte* block) const;

    const Bc7Effort effort_;
    const int lanes_;
    bool has_alpha_ = false;
    WorkingVector<Texels> texels_;
    WorkingVector<Try> tries_;
    WorkingVector<Part> parts_, sorted_;
    struct Indices {
        std::uint8_t color[16], scalar[16];
    };
    WorkingVector<Indices> indices_;
    float apart_[kMost][3];  // the error of alpha in a plane of its own
    Bc7Group group_;
    Bc7Guesses guesses_;
};

}  // namespace tex::inline v1
