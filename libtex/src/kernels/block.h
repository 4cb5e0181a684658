// SPDX-License-Identifier: Apache-2.0
// block.h: the data about a block that the searches for endpoints use.

#pragma once

#include <algorithm>
#include <limits>

#include "blocks/texels.h"

namespace tex::inline v1 {

// In codes relative to `base`.
struct Block {
    float v[16];  // texels outside the level are replaced by the mean, so that sums do not change
    int base;     // the greatest whole code that is not above any texel
    int length;   // from base to the least whole code that is not below any texel
    float count;  // texels in the level
    float mean;
    float deviations;  // the sum of the squared deviations from the mean
    float least, greatest;
    float slack;  // bounds the rounding of errors, in codes squared: smaller if all texels are whole codes, because
                  // tables then have no rounding
};

inline Block measure(const BlockTexels& texels) {
    std::int32_t least = std::numeric_limits<std::int32_t>::max();
    std::int32_t greatest = 0;
    std::int32_t bits = 0;
    std::int32_t sum = 0;
    std::int32_t count = 0;
    for (int k = 0; k < 16; ++k) {
        const std::int32_t value = texels.values[k];
        const bool inside = texels.mask >> k & 1;
        least = std::min(least, inside ? value : least);
        greatest = std::max(greatest, inside ? value : greatest);
        sum += inside ? value : 0;
        count += inside;
        bits |= value;
    }
    constexpr float kCode = 1.0f / kCodeUnit;
    Block block;
    block.base = least / kCodeUnit;
    block.length = (greatest + kCodeUnit - 1) / kCodeUnit - block.base;
    block.count = static_cast<float>(count);
    const std::int32_t base = block.base * kCodeUnit;
    block.mean = static_cast<float>(sum - count * base) / block.count * kCode;
    block.least = static_cast<float>(least - base) * kCode;
    block.greatest = static_cast<float>(greatest - base) * kCode;
    block.deviations = 0.0f;
    for (int k = 0; k < 16; ++k) {
        block.v[k] = texels.mask >> k & 1 ? static_cast<float>(texels.values[k] - base) * kCode : block.mean;
        const float d = block.v[k] - block.mean;
        block.deviations += d * d;
    }
    const float range = block.greatest - block.least;
    block.slack = (bits % kCodeUnit == 0 ? 1e-5f : 1e-4f) * range * range + 1e-6f;
    return block;
}

}  // namespace tex::inline v1
