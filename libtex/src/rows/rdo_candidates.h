// SPDX-License-Identifier: Apache-2.0
// rdo_candidates.h: the bytes that one half of a block may get, with what they decode to, measured all at once.

#pragma once

#include <array>
#include <cstddef>

#include "blocks/block_half.h"

namespace tex::inline v1 {

struct RdoCandidate {
    std::byte half[kHalfBytes];
    int distance;  // of what is copied, in bytes; 0: nothing is
    int literals;  // bytes in front of the copy
    float bits;    // of the literals
};

// The half that candidates are for, and the prices of its errors and bits.
struct RdoAim {
    HalfKind kind;
    const float* values;  // 16
    float rest;           // the squared error of the other half
    float scale;          // from the root of both halves' squared error to the sum of angles
    float lambda;
    const std::array<float, 256>* literal_bits;
};

class RdoCandidates {
public:
    static constexpr int kMost = 80;

    void start(const RdoAim& aim) {
        aim_ = aim;
        count_ = 0;
    }
    // Forgets all candidates but the first ones.
    void keep(int count) { count_ = count; }
    void add_literals(const std::byte* half);
    // Adds the best copies from the half at this distance: at most `most`, and at most kMostCopies.
    static constexpr int kMostCopies = 3;
    void add_copies(const std::byte* from, int distance, Copied copied, int most = kMostCopies);

    [[nodiscard]] int count() const { return count_; }
    [[nodiscard]] const RdoCandidate& operator[](int index) const {
        return candidates_[static_cast<std::size_t>(index)];
    }
    // The decoded components: those of texel k from k * kStride on, with room for a vector past the last one.
    static constexpr int kStride = kMost + 16;
    [[nodiscard]] const float* values() const { return values_.data(); }
    void copy_values(int index, float values[16]) const;

private:
    void add(const std::byte* half, int distance, int literals);

    RdoAim aim_{};
    int count_ = 0;
    std::array<RdoCandidate, kMost> candidates_;
    std::array<float, std::size_t{16} * kStride> values_{};
};

}  // namespace tex::inline v1
