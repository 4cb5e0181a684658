// SPDX-License-Identifier: Apache-2.0
// basis_slice.h: decodes a slice of BasisLZ, which is an image of ETC1S blocks, a row of blocks at a time (KTX 2.0,
// "ETC1S Slice").

#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <tex/types.h>

#include "formats/ktx2/basis_codebooks.h"

namespace tex::inline v1 {

class BasisSlice {
public:
    // Both must outlive the slice. May throw std::bad_alloc.
    BasisSlice(const BasisCodebooks& books, std::span<const std::byte> bytes, int blocks_across, int blocks_down);

    // Decodes the next row into blocks that are `stride` bytes apart. Errors: bad_data, without the name of the file.
    Result<void> next_row(std::byte* blocks, std::size_t stride);

private:
    // The selectors that were used last, roughly in the order of use.
    class History {
    public:
        explicit History(std::uint32_t size) : selectors_(size), next_(size / 2) {}
        [[nodiscard]] std::size_t size() const { return selectors_.size(); }
        void add(std::uint16_t selector) {
            selectors_[next_++] = selector;
            if (next_ == selectors_.size()) next_ = selectors_.size() / 2;
        }
        std::uint16_t use(std::size_t k) {
            const std::uint16_t selector = selectors_[k];
            selectors_[k] = selectors_[k / 2];
            selectors_[k / 2] = selector;
            return selector;
        }

    private:
        std::vector<std::uint16_t> selectors_;
        std::size_t next_;
    };

    // How the endpoints of a block follow from those of its neighbours.
    enum Prediction : std::uint32_t { left, above, above_left, step };

    [[nodiscard]] std::uint32_t next_predictions();
    // The numbers of endpoints and selectors; one that does not exist if the data are damaged.
    [[nodiscard]] std::size_t next_endpoint(std::uint32_t prediction, std::size_t i, std::size_t above_left_one);
    [[nodiscard]] std::size_t next_selector();

    static constexpr std::size_t kNone = ~std::size_t{0};

    const BasisCodebooks& books_;
    BasisBits bits_;
    const std::uint64_t blocks_;
    int row_ = 0;
    std::vector<std::uint16_t> above_;       // the endpoints of the row above, then of this one
    std::vector<std::uint8_t> predictions_;  // of the second of two rows
    std::uint32_t last_predictions_ = 0;
    std::uint64_t repeats_ = 0;  // how often they come again
    std::size_t last_endpoint_ = 0;
    History history_;
    std::uint64_t run_ = 0;  // blocks that use the first selector of the history
};

}  // namespace tex::inline v1
