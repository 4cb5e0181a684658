// SPDX-License-Identifier: Apache-2.0
// candidates.h: the pairs of endpoints that a search has met and that may be the best one.

#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

namespace tex {

// A pair: the greater endpoint lies `distance` above the lower one; `kind` 0 is preferred to 1 among equals.
struct Candidate {
    float error;
    int lower;
    int distance;
    int kind;
};

// Keeps the candidates whose error, computed in float, is within `slack` (the bound of its rounding) of the least one,
// and in the end picks the best by `exact`, a function from Candidate to std::int64_t. Of equals: the smallest
// distance, then the smallest kind, then the greatest lower endpoint; but the first pair without any error ends the
// search.
//
// The outcome does not depend on how many pairs are looked at together: whatever the limit was on the way, all that are
// within the final one are in the list.
template <class Exact>
class Candidates {
public:
    Candidates(float slack, Exact exact) : slack_(slack), exact_(exact) {}

    // The error above which a pair cannot be the best.
    [[nodiscard]] float limit() const { return least_ + slack_; }

    // A pair without error has been found.
    [[nodiscard]] bool perfect() const { return perfect_; }

    void add(const Candidate& candidate) {
        if (perfect_ || candidate.error > limit()) return;
        least_ = std::min(least_, candidate.error);
        if (count_ == kCapacity) settle();
        list_[count_++] = candidate;
        if (candidate.error <= slack_ && exact_(candidate) == 0) {
            list_[0] = candidate;
            count_ = 1;
            perfect_ = true;
        }
    }

    // The best of those added so far, of which there must be one.
    Candidate settle() {
        const int count = static_cast<int>(
            std::remove_if(list_, list_ + count_, [&](const Candidate& c) { return c.error > limit(); }) - list_);
        Candidate best = list_[0];
        std::int64_t least = count > 1 ? exact_(best) : 0;
        for (int k = 1; k < count; ++k) {
            const std::int64_t error = exact_(list_[k]);
            if (error < least || (error == least && precedes(list_[k], best))) {
                least = error;
                best = list_[k];
            }
        }
        list_[0] = best;
        count_ = 1;
        return best;
    }

private:
    static bool precedes(const Candidate& a, const Candidate& b) {
        if (a.distance != b.distance) return a.distance < b.distance;
        if (a.kind != b.kind) return a.kind < b.kind;
        return a.lower > b.lower;
    }

    static constexpr int kCapacity = 64;
    const float slack_;
    const Exact exact_;
    float least_ = 1e30f;
    bool perfect_ = false;
    int count_ = 0;
    Candidate list_[kCapacity];
};

}  // namespace tex
