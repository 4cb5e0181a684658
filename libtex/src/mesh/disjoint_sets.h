// SPDX-License-Identifier: Apache-2.0
// disjoint_sets.h: sets of numbers that grow together (Galler and Fischer, An Improved Equivalence Algorithm, 1964).

#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace tex::inline v1 {

// Sets of the numbers from 0 to count - 1. At first, each set has one number.
class DisjointSets {
public:
    explicit DisjointSets(std::size_t count) : parents_(count) { std::iota(parents_.begin(), parents_.end(), 0U); }

    // The number that stands for the set of `k`.
    std::uint32_t root(std::uint32_t k) {
        while (parents_[k] != k) k = parents_[k] = parents_[parents_[k]];
        return k;
    }
    // Makes the set of the root `child` part of the set of the root `to`, which keeps its root.
    void attach(std::uint32_t child, std::uint32_t to) { parents_[child] = to; }
    void join(std::uint32_t a, std::uint32_t b) { attach(root(a), root(b)); }

private:
    std::vector<std::uint32_t> parents_;
};

}  // namespace tex::inline v1
