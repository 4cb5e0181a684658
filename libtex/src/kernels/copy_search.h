// SPDX-License-Identifier: Apache-2.0
// copy_search.h: searches earlier blocks for what a block may copy (rate-distortion optimisation, rows/rdo_pass.h).

#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "kernels/copy_values.h"

namespace tex::inline v1 {

// Halves that may be copied: directions and sizes of what they decode to, an array for each part, and their shapes. The
// arrays can be read a whole vector (64 bytes) past their last value.
struct CopyTable {
    const std::int16_t* parts[16];
    const std::int16_t* means;
    const std::int16_t* lengths;
    const CopyHalf* halves;
};

// What may be copied, in the order of its cost.
struct CheapCopy {
    float cost;
    int at;      // the half of the table
    int copied;  // the index of its errors
};

class CheapCopies {
public:
    static constexpr int kMost = 6, kRoom = 16;

    // Takes no copies whose cost is not below `limit`, and at most `most`, up to kRoom.
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
    std::array<CheapCopy, kRoom> copies_{};
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

}  // namespace tex::inline v1
