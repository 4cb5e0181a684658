// SPDX-License-Identifier: Apache-2.0

#include "rows/rdo_rate.h"

#include <algorithm>
#include <bit>
#include <cstddef>

#include "rows/math.h"

namespace tex::inline v1 {
namespace {

// What zstd -19 writes for a match: the codes of its lengths and of the class of its distance, and the bits of the
// distance below its highest one.
constexpr float kMatchBits = 4.0f;
constexpr float kRepeatBits = 3.0f;   // at the last distance
constexpr float kOlderRepeat = 0.7f;  // more for each distance before it
constexpr float kLongerBits = 0.3f;   // for a match that goes on

}  // namespace

std::array<float, 256> literal_bits(const ByteCounts& counts) {
    double total = 0.0;
    for (const std::int64_t count : counts) total += static_cast<double>(count + 1);
    std::array<float, 256> bits;
    for (std::size_t k = 0; k < bits.size(); ++k) {
        const double rarity = math::log(total / static_cast<double>(counts[k] + 1)) / math::log(2.0);
        bits[k] = std::max(1.0f, static_cast<float>(rarity));
    }
    return bits;
}

float match_bits(int distance) {
    return kMatchBits + static_cast<float>(std::bit_width(static_cast<unsigned>(distance) + 3u)) - 1.0f;
}

float RdoMatches::bits(int distance, bool whole) const {
    if (whole && open_ == distance) return kLongerBits;
    for (std::size_t k = 0; k < last_.size(); ++k) {
        if (last_[k] == distance) return kRepeatBits + kOlderRepeat * static_cast<float>(k);
    }
    return match_bits(distance);
}

void RdoMatches::use(int distance) {
    open_ = distance;
    if (distance == 0 || last_[0] == distance) return;
    if (last_[1] != distance) last_[2] = last_[1];
    last_[1] = last_[0];
    last_[0] = distance;
}

}  // namespace tex::inline v1
