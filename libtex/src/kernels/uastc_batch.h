// SPDX-License-Identifier: Apache-2.0
// uastc_batch.h: many blocks of UASTC that are encoded together, so that those with the same mode fill vectors.

#pragma once

#include <cstddef>
#include <cstdint>

#include <tex/pack.h>

#include "blocks/uastc_write.h"
#include "kernels/uastc_fit.h"
#include "kernels/uastc_hints.h"
#include "memory/lent_memory.h"

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
};
[[nodiscard]] UastcEffort uastc_effort(Effort effort);

class UastcBatch {
public:
    static constexpr int kMost = 256;  // blocks

    // Takes memory.
    explicit UastcBatch(const UastcEffort& effort);
    [[nodiscard]] static std::size_t memory(const UastcEffort& effort);

    // The texels of a block: x, y, z of a vector, row by row.
    float (*texels(int block))[3] { return texels_[static_cast<std::size_t>(block)].value; }

    // Encodes the first `count` blocks.
    void encode(int count, std::byte* blocks);

private:
    struct Texels {
        float value[16][3];
    };
    // A way to encode a block.
    struct Try {
        float error;
        std::int16_t block;
        std::uint8_t kind, pattern;
        std::uint8_t component[3];  // of two planes: that of the second one, and those of the first
        std::uint8_t ends[3][2][3];
    };
    // A subset of a try, of which subset 0 is all.
    struct Part {
        int index;  // of the try
        std::uint16_t mask;
        std::uint8_t subset, texels;
    };
    struct Indices {
        std::uint8_t line[16], second[16];
    };

    void prepare(int count);
    void add_tries(int block, int lane);
    void drop_hopeless();
    void sort_parts();
    void fit(int first, int end, const Bc7Steps& steps);
    void gather(const Try& from, const Part& part, int lane);
    void scatter(const Part& part, int lane, bool indices, Try& to);
    void keep(int count);
    [[nodiscard]] UastcContent content_of(const Try& found) const;
    void gather_hints(const UastcContent& content, int lane);
    void write(int count, std::byte* blocks);
    bool write_solid(int block, std::byte* to);

    const UastcEffort effort_;
    const int lanes_;
    WorkingVector<Texels> texels_;
    WorkingVector<Try> tries_;
    WorkingVector<Part> parts_, sorted_;
    WorkingVector<Indices> indices_;
    Bc7Group group_;
    UastcGuesses guesses_;
    UastcHintGroup hints_;
};

}  // namespace tex::inline v1
