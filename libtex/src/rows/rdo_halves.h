// SPDX-License-Identifier: Apache-2.0
// rdo_halves.h: the halves of one channel that later blocks may copy.

#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "blocks/block_half.h"
#include "kernels/copy_search.h"

namespace tex::inline v1 {

// Grows by a half at a time.
class RdoHalves {
public:
    RdoHalves(HalfKind kind, std::size_t most);
    [[nodiscard]] HalfKind kind() const { return kind_; }
    void add(const std::byte* half);
    [[nodiscard]] const CopyHalf& operator[](std::size_t index) const { return halves_[index]; }
    // The halves from number `first` on, as a table for the kernels.
    [[nodiscard]] CopyTable from(std::size_t first) const;

private:
    const HalfKind kind_;
    std::vector<std::int16_t> parts_[16], means_, lengths_;
    std::vector<CopyHalf> halves_;
};

}  // namespace tex::inline v1
