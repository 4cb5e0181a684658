// SPDX-License-Identifier: Apache-2.0
// copy_search.h: searches earlier blocks for what a block may copy (rate-distortion optimisation, rows/rdo_pass.h).

#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "blocks/half_block.h"

namespace tex::inline v1 {

// The shape (blocks/half_block.h) of a half that may be copied.
struct CopyHalf {
    HalfShape shape;
    float sum;      // of the weights
    float squares;  // the sum of their squares
    float inverse;  // 1 / (16 squares - sum^2), or 0 if all weights are equal
};
[[nodiscard]] CopyHalf copy_half(const HalfShape& shape);

// 16 numbers without their mean, as a unit vector in the cosine basis (of 4x4 texels, orthonormal), in units of
// 1/kDirectionUnit: the three lowest frequencies, the length of all others, rounded up, and the twelve others. Zeros if
// all numbers are equal.
inline constexpr int kDirectionUnit = 32000;
struct CopyDirection {
    std::int16_t parts[16];
};
[[nodiscard]] CopyDirection copy_direction(const float values[16]);

// The mean of 16 numbers, and the root of the sum of the squares of their distances from it, in units of 1/kMeanUnit
// and 1/kLengthUnit, rounded and limited to what 16 bits hold.
inline constexpr float kMeanUnit = 32000.0f;
inline constexpr float kLengthUnit = 8000.0f;
struct CopySize {
    std::int16_t mean, length;
};
[[nodiscard]] CopySize copy_size(float mean, float length);

// Halves that may be copied: directions and sizes of what they decode to, an array for each part, and their shapes. The
// arrays can be read a whole vector (64 bytes) past their last value.
struct CopyTable {
    const std::int16_t* parts[16];
    const std::int16_t* means;
    const std::int16_t* lengths;
    const CopyHalf* halves;
};

// The values of a half that searches for what it may copy.
struct CopyValues {
    float values[16];
    float sum, squares;  // of the values, and of their squares
    CopyDirection direction;
    CopySize size;
};
[[nodiscard]] CopyValues copy_values(const float values[16]);

// The least sums of squared differences between 16 values and those of a half with the weights of another one,
//     [0]    whose offset and slope are free
//     [1]    whose slope is that of the other half, if keeps_slope is set; otherwise, whose offset is
//     [2]    whose offset and slope are those of the other half
// The later two are never less than the first. Rounding to codes is ignored. All are quadratic forms of the sums of the
// values, of the weights, of their squares and of their products.
[[nodiscard]] std::array<float, 3> copy_errors(const CopyHalf& half, const CopyValues& values, bool keeps_slope);

// What may be copied, in the order of its cost.
struct CheapCopy {
    float cost;
    int at;      // the half of the table
    int copied;  // the index of its errors
};

class CheapCopies {
public:
    static constexpr int kMost = 6;

    // Takes no copies whose cost is not below `limit`, and at most `most`.
    explicit CheapCopies(float limit = 3e38f, int most = kMost) : most_(most), limit_(limit) {}

    void add(CheapCopy copy) {
        if (copy.cost >= bound()) return;
        int k = count_ == most_ ? most_ - 1 : count_++;
        for (; k > 0 && copies_[static_cast<std::size_t>(k - 1)].cost > copy.cost; --k)
            copies_[static_cast<std::size_t>(k)] = copies_[static_cast<std::size_t>(k - 1)];
        copies_[static_cast<std::size_t>(k)] = copy;
        if (count_ == most_) limit_ = std::min(limit_, copies_[static_cast<std::size_t>(most_ - 1)].cost);
    }
    // Costs that are not below this one need not be added.
    [[nodiscard]] float bound() const { return limit_; }
    [[nodiscard]] const CheapCopy* begin() const { return copies_.data(); }
    [[nodiscard]] const CheapCopy* end() const { return copies_.data() + count_; }

private:
    std::array<CheapCopy, kMost> copies_{};
    int most_;
    float limit_;
    int count_ = 0;
};

// A block that searches among `count` earlier blocks. The cost of half k of a channel, with its errors q, is
//     scale * sqrt(copy_errors(...)[q] + rests[to]) + prices[k] + extra[to][q]
// for x (to = 0) and y, which take from their own channel and, if `is_across` is set, from the other one. That of a
// pair, where x and y copy from the same block, is
//     scale * sqrt(errors of x[q] + errors of y[q]) + prices[k] + extra[2][q]
// The last `extra` is the least. Errors [1] count only if keeps_slope is set: elsewhere such copies hardly gain. Of
// equal costs, the later half comes first, then that of y.
struct CopySearch {
    const CopyTable* tables[2];
    const CopyValues* values[2];
    bool is_across;
    bool keeps_slope;
    int count;
    float scale;
    float rests[2];
    const float* prices;  // the later the half, the lower
    float extra[3][3];
};
struct FoundCopies {
    CheapCopies of[2][2];  // of x and y; from x or y
    CheapCopies pairs;
};
void find_copies(const CopySearch& search, FoundCopies& found);

// The lengths of the chords |n - m| between 16 unit normals and the decoded components x and y, as readers make normals
// of them: (x, y, sqrt(1 - x^2 - y^2)), or the unit vector along (x, y, 0) where x^2 + y^2 is above 1.
void block_chords(const float* const normals[3], const float x[16], const float y[16], float chords[16]);

// For many candidates for one component of a block's texels: the sum of the chords that block_chords() computes, each
// times `inside`, in the order of the texels; or kTooLong if a chord is longer than `most`.
inline constexpr float kTooLong = 1e30f;
struct ChordTexels {
    const float* own;    // the component that candidates replace, of the normals
    const float* other;  // the other one
    const float* z;
    const float* decoded;  // the other component of all candidates
    const float* most;
    const float* inside;
};
// `values` has the candidates of texel k from k * stride on. The rows of `values`, and `sums`, have room for a whole
// vector past the last candidate.
void chord_sums(const ChordTexels& texels, const float* values, int stride, int count, float* sums);

}  // namespace tex::inline v1
