// SPDX-License-Identifier: Apache-2.0
// copy_search.h: searches earlier blocks for what a block may copy (rate-distortion optimisation, rows/rdo_pass.h).

#pragma once

#include <array>
#include <cstddef>

namespace tex {

// The shapes (blocks/half_block.h) of many halves, an array for each property. Arrays can be read a whole vector (64
// bytes) past their last value.
struct LineTable {
    const float* weights[16];
    const float* sum;      // of the weights
    const float* squares;  // the sum of their squares
    const float* inverse;  // 1 / (16 squares - sum^2), or 0 if all weights are equal or the shape is not a line
    const float* offset;
    const float* slope;
};

// What copies of halves of a table for 16 values are scored by.
struct CopyScores {
    LineTable table;
    bool keeps_slope;       // see copy_errors()
    float sum, squares;     // of the values, and of their squares
    const float* products;  // of weights and values, summed, for each half
    const float* least;     // the least sum of squared differences, with offset and slope free, for each half
};
// Computes the scores of halves 0 to count - 1. Both arrays have room for a whole vector past the last value.
CopyScores score_copies(const LineTable& table, int count, const float values[16], bool keeps_slope, float* products,
                        float* least);

// The least sums of squared differences between the 16 values and the values of a half with the weights of half `at`,
//     [0]    whose offset and slope are free
//     [1]    whose slope is that of the table, if keeps_slope is set; otherwise, whose offset is
//     [2]    whose offset and slope are those of the table
// The later two are never less than the first. Rounding to codes is ignored.
std::array<float, 3> copy_errors(const CopyScores& scores, int at);

// What may be copied, in the order of its cost.
struct CheapCopy {
    float cost;
    int at;      // the half of the table
    int copied;  // the index of its errors
};

class CheapCopies {
public:
    static constexpr int kMost = 6;

    void add(CheapCopy copy) {
        if (count_ == kMost && copy.cost >= copies_[kMost - 1].cost) return;
        int k = count_ == kMost ? kMost - 1 : count_++;
        for (; k > 0 && copies_[static_cast<std::size_t>(k - 1)].cost > copy.cost; --k)
            copies_[static_cast<std::size_t>(k)] = copies_[static_cast<std::size_t>(k - 1)];
        copies_[static_cast<std::size_t>(k)] = copy;
    }
    // Costs that are not below this one need not be added.
    [[nodiscard]] float bound() const { return count_ == kMost ? copies_[kMost - 1].cost : 3e38f; }
    [[nodiscard]] const CheapCopy* begin() const { return copies_.data(); }
    [[nodiscard]] const CheapCopy* end() const { return copies_.data() + count_; }

private:
    std::array<CheapCopy, kMost> copies_{};
    int count_ = 0;
};

// Adds those of the halves 0 to count - 1 that are among the cheapest. The cost of half k with errors q is
//     scale * sqrt(copy_errors(*scores, k)[q] + copy_errors(*more, k)[q] + rest) + prices[k] + extra[q]
// `more` may be null, which counts as zeros. Of equal costs, the later half comes first.
struct CopyCosts {
    const CopyScores* scores;
    const CopyScores* more;
    float rest;
    float scale;
    const float* prices;
    float extra[3];  // the last one is the least
};
void add_cheapest(const CopyCosts& costs, int count, CheapCopies& cheapest);

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

}  // namespace tex
