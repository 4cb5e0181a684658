// SPDX-License-Identifier: Apache-2.0
// candidates.h: the pairs of endpoints that a search has found and that may be the best one.

#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

namespace tex::inline v1 {

// A pair: the greater endpoint lies `distance` above the lower one. Among equals, `kind` 0 is preferred to 1.
struct Candidate {
    float error;
    int lower;
    int distance;
    int kind;
};

// Keeps the candidates whose error, computed in float, is within `slack` (the bound of its rounding) of the least one.
// In the end it picks the best of them by `exact`, a function from Candidate to std::int64_t. Among equals, it prefers
// the smallest distance, then the smallest kind, then the greatest lower endpoint; but the first pair without error
// ends the search.
//
// The result does not depend on how many pairs are scored at once: all pairs within the final limit are in the list,
// whatever the limit was before.
template <class Exact>
class Candidates {
public:
    Candidates(float slack, Exact exact) : slack_(slack), exact_(exact) {}

    // The error above which a pair cannot be the best.
    [[nodiscard]] float limit() const { return least_ + slack_; }

    // Whether a pair without error has been found.
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

    // Returns the best candidate added so far. Precondition: there is one.
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

}  // namespace tex::inline v1
