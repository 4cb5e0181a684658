// SPDX-License-Identifier: Apache-2.0
// rdo_halves.h: the halves of one channel that later blocks may copy.

#pragma once

#include <cstddef>
#include <vector>

#include "blocks/half_block.h"
#include "kernels/copy_search.h"

namespace tex {

// What arrays that kernels read and write by whole vectors have past their end.
inline constexpr int kVectorSlack = 16;

// Grows by a half at a time.
class RdoHalves {
public:
    RdoHalves(HalfKind kind, std::size_t most);
    [[nodiscard]] HalfKind kind() const { return kind_; }
    void add(const std::byte* half);
    // The halves from number `first` on, as a table for the kernels.
    [[nodiscard]] LineTable from(std::size_t first) const;

private:
    const HalfKind kind_;
    std::size_t count_ = 0;
    std::vector<float> weights_[16];
    std::vector<float> sum_, squares_, inverse_, offset_, slope_;
};

}  // namespace tex
