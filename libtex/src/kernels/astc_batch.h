// SPDX-License-Identifier: Apache-2.0
// astc_batch.h: encodes many blocks of ASTC together, so that those of the same plan can be fitted side by side.

#pragma once

#include <cstddef>
#include <cstdint>

#include "blocks/astc_plan.h"
#include "kernels/astc_effort.h"
#include "kernels/astc_fit.h"
#include "kernels/astc_guess.h"
#include "kernels/astc_guide.h"
#include "memory/lent_memory.h"

namespace tex::inline v1 {

// Floats that begin at a multiple of 64 bytes, not set.
class AlignedFloats {
public:
    explicit AlignedFloats(std::size_t count) { room_.reserve(count + kAlign / sizeof(float)); }
    float* data() {
        const auto at = reinterpret_cast<std::uintptr_t>(room_.data());
        return room_.data() + (kAlign - at % kAlign) % kAlign / sizeof(float);
    }

private:
    static constexpr std::size_t kAlign = 64;
    WorkingVector<float> room_;  // stays empty: zeros would take time
};

class AstcBatch {
public:
    // Holds at most so many blocks. Takes memory.
    AstcBatch(const AstcGuide& guide, const AstcEffort& effort, int most);

    // The first texel of a channel of a block; the others follow at distances of lanes().
    float* values(int block, int channel) {
        return values_.data() +
               static_cast<std::size_t>((block / lanes_ * 2 + channel) * texels_ * lanes_ + block % lanes_);
    }
    [[nodiscard]] int lanes() const { return lanes_; }
    // The bytes for each block that a batch of the effort takes, without the texels.
    [[nodiscard]] static std::size_t bytes_a_block(const AstcEffort& effort);

    // Encodes the first `count` blocks.
    void encode(int count, std::byte* blocks);

private:
    struct Candidate {
        int block, plan, pattern;
        float error = 0;
        unsigned offsets = 0;  // a bit for each partition that has a base and an offset
        unsigned turns = 0;    // a bit for each partition whose line is turned
        int place = 0;         // among the others: std::sort() keeps no order
    };

    struct Found {
        Found() {}  // not all of the content is set, which would take time
        float error = kAstcNone;
        int plan = -1;
        AstcContent content;
    };

    void gather(const Candidate* candidates, int used);
    // Precondition: the candidate has several partitions.
    [[nodiscard]] const AstcPattern& pattern_of(const Candidate& candidate) const {
        return guide_.patterns[plans_.plans[static_cast<std::size_t>(candidate.plan)].partitions - 2]
                              [static_cast<std::size_t>(candidate.pattern)];
    }
    AstcGroup group(int first);
    void add(int block, int number, int pattern, unsigned bits);
    void add_guesses(int block, int lane, float most, const unsigned* bits);
    void guess();
    void guess_parts(int partitions, float worth);
    void fit(const AstcSteps& steps, std::size_t begin);
    void fit_some(const AstcSteps& steps, Candidate* candidates, int used);
    void sort_by_plan(std::size_t begin);
    void keep_best_candidates();
    void write(int block, std::byte* bytes);

    const AstcGuide& guide_;
    const AstcEffort& effort_;
    const AstcPlans& plans_;
    const int lanes_, texels_;
    AlignedFloats values_;  // of groups of lanes_ blocks: channels, texels, blocks
    WorkingVector<Found> found_;
    WorkingVector<float> range_;
    WorkingVector<Candidate> candidates_;
    WorkingVector<Candidate> some_;
    WorkingVector<int> ends_;  // of candidates of a plan
    alignas(64) float gathered_[3][kAstcMostPlanned * kAstcLanes];
    alignas(64) float offsets_[3 * kAstcLanes], turns_[3 * kAstcLanes];
    AstcFits fits_;
    AstcGuesses guesses_;
};

}  // namespace tex::inline v1
