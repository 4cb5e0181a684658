// SPDX-License-Identifier: Apache-2.0

#include "rows/height_steps.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace tex::inline v1 {
namespace {

constexpr int kSlots = 4 * kMostCodes;
constexpr double kCoarsest = 1.0 / 32.0;  // the largest step, and the inverse of the fewest steps of taller heights
// Half a step of 16 bits and some rounding: what a program that stretches 8 bits to 16 adds.
constexpr double kRounding = 0.6 / 65535.0;

std::size_t slot_of(float height) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &height, sizeof(bits));
    return (bits * 2654435761U) >> (32 - 14);
}
static_assert(kSlots == 1 << 14);

// Whether all heights lie on steps of about `step`, which is improved from one height to the next.
bool lie_on(std::span<const float> sorted, double slack, double& step) {
    const auto lowest = static_cast<double>(sorted.front());
    for (const float height : sorted) {
        const double rise = static_cast<double>(height) - lowest;
        const double count = std::round(rise / step);
        if (std::abs(rise - count * step) > std::min(2.0 * slack, 0.25 * step)) return false;
        if (count > 0.0) step = rise / count;
    }
    return std::all_of(sorted.begin(), sorted.end(), [&](float height) {
        const double rise = static_cast<double>(height) - lowest;
        return std::abs(rise - std::round(rise / step) * step) <= std::min(2.0 * slack, 0.1 * step);
    });
}

}  // namespace

DistinctHeights::DistinctHeights() : slots_(kSlots, std::numeric_limits<float>::quiet_NaN()) {}

void DistinctHeights::insert(float height) {
    std::size_t at = slot_of(height);
    while (!std::isnan(slots_[at])) {
        if (slots_[at] == height) return;
        at = (at + 1) % kSlots;
    }
    slots_[at] = height;
    ++used_;
}

void DistinctHeights::add(const float* row, int count) {
    float last = std::numeric_limits<float>::quiet_NaN();
    for (int i = 0; i < count && !too_many(); ++i) {
        if (row[i] == last || std::isnan(row[i])) continue;
        last = row[i] + 0.0f;  // -0 is 0
        insert(last);
    }
}

void DistinctHeights::add(const DistinctHeights& other) { add(other.slots_.data(), kSlots); }

WorkingVector<float> DistinctHeights::sorted() const {
    WorkingVector<float> heights;
    heights.reserve(static_cast<std::size_t>(used_));
    std::copy_if(slots_.begin(), slots_.end(), std::back_inserter(heights), [](float h) { return !std::isnan(h); });
    std::sort(heights.begin(), heights.end());
    return heights;
}

std::optional<HeightSteps> find_steps(std::span<const float> sorted) {
    if (sorted.size() < 2) return std::nullopt;
    const auto lowest = static_cast<double>(sorted.front()), highest = static_cast<double>(sorted.back());
    double least = highest - lowest;
    for (std::size_t k = 1; k < sorted.size(); ++k)
        least = std::min(least, static_cast<double>(sorted[k]) - static_cast<double>(sorted[k - 1]));
    const double slack = std::max(kRounding, 0x1p-22 * std::max(std::abs(lowest), std::abs(highest)));
    // If no two neighbouring codes occur, the step is a part of the least distance.
    for (const double part : {1.0, 2.0, 3.0}) {
        double step = least / part;
        if (!(step > 5.0 * slack)) break;
        const double rise = highest - lowest;
        if (rise / step > kMostCodes || (step > kCoarsest && rise * kCoarsest < step)) continue;
        if (!lie_on(sorted, slack, step)) continue;
        return HeightSteps{sorted.front(), static_cast<float>(step), static_cast<int>(std::round(rise / step)) + 1};
    }
    return std::nullopt;
}

std::int64_t count_terraces(const float* above, const float* row, const float* below, int count) {
    std::int64_t found = 0;
    for (int i = 0; i < count; ++i) {
        const bool along = i > 0 && i + 1 < count && row[i - 1] == row[i] && row[i + 1] == row[i];
        const bool across = above != nullptr && below != nullptr && above[i] == row[i] && below[i] == row[i];
        found += along || across ? 1 : 0;
    }
    return found;
}

}  // namespace tex::inline v1
