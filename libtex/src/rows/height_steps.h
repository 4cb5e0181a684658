// SPDX-License-Identifier: Apache-2.0
// height_steps.h: finds the steps that heights lie on.

#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "memory/lent_memory.h"

namespace tex::inline v1 {

// The most steps from the lowest height to the highest. (Finer ones are no terraces: 12 bits are smooth.)
inline constexpr int kMostCodes = 4096;

// Collects the different heights of some rows, until there are more than kMostCodes.
class DistinctHeights {
public:
    DistinctHeights();

    void add(const float* row, int count);  // NaN does not count
    void add(const DistinctHeights& other);
    [[nodiscard]] bool too_many() const { return used_ > kMostCodes; }
    [[nodiscard]] WorkingVector<float> sorted() const;

private:
    void insert(float height);

    WorkingVector<float> slots_;  // an open hash table; NaN: free
    int used_ = 0;
};

struct HeightSteps {
    float lowest = 0.0f;
    float step = 0.0f;
    int codes = 0;
};

// The steps that all of `sorted` lie on, as height.h describes them; nullopt if there are none.
std::optional<HeightSteps> find_steps(std::span<const float> sorted);

// Counts the texels of a row that have the height of both neighbours along x or y. `above` and `below` may be null.
std::int64_t count_terraces(const float* above, const float* row, const float* below, int count);

}  // namespace tex::inline v1
