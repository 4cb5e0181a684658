// SPDX-License-Identifier: Apache-2.0

#include "rows/rdo_candidates.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

namespace tex::inline v1 {

void RdoCandidates::add(const std::byte* half, int distance, int literals) {
    assert(count_ < kMost);
    RdoCandidate& candidate = candidates_[static_cast<std::size_t>(count_)];
    std::memcpy(candidate.half, half, kHalfBytes);
    candidate.distance = distance;
    candidate.literals = literals;
    candidate.bits = 0.0f;
    for (int k = 0; k < literals; ++k) candidate.bits += (*aim_.literal_bits)[std::to_integer<std::size_t>(half[k])];
    float values[16];
    decode_half(aim_.kind, half, values);
    float* const column = values_.data() + count_++;
    for (std::ptrdiff_t k = 0; k < 16; ++k) column[k * kStride] = values[k];
}

void RdoCandidates::add_literals(const std::byte* half) { add(half, 0, kHalfBytes); }

void RdoCandidates::add_copies(const std::byte* from, int distance, Copied copied, int most) {
    if (copied == Copied::all) {
        add(from, distance, 0);
        return;
    }
    const HalfShape shape = half_shape(aim_.kind, from);
    if (!shape.is_line) return;
    const HalfFit fit(shape, aim_.values);
    HalfVariant variants[kMostVariants];
    const int count = half_variants(aim_.kind, from, copied, fit.line(aim_.kind, copied), variants);
    const int literals = literals_before(aim_.kind, copied);
    // Decoding and measuring costs more than an estimate of the angles.
    float costs[kMostVariants];
    for (int v = 0; v < count; ++v) {
        costs[v] = aim_.scale * std::sqrt(fit.squared_error(variants[v].line) + aim_.rest);
        for (int k = 0; k < literals; ++k)
            costs[v] += aim_.lambda * (*aim_.literal_bits)[std::to_integer<std::size_t>(variants[v].half[k])];
    }
    for (int taken = 0; taken < std::min({most, kMostCopies, count}); ++taken) {
        float* const least = std::min_element(costs, costs + count);
        add(variants[least - costs].half, distance, literals);
        *least = 1e30f;
    }
}

void RdoCandidates::copy_values(int index, float values[16]) const {
    const float* const column = values_.data() + index;
    for (std::ptrdiff_t k = 0; k < 16; ++k) values[k] = column[k * kStride];
}

}  // namespace tex::inline v1
