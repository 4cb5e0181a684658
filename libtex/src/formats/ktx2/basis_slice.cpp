// SPDX-License-Identifier: Apache-2.0

#include "formats/ktx2/basis_slice.h"

#include <algorithm>

namespace tex::inline v1 {

BasisSlice::BasisSlice(const BasisCodebooks& books, std::span<const std::byte> bytes, int blocks_across,
                       int blocks_down)
    : books_(books), bits_(bytes),
      blocks_(static_cast<std::uint64_t>(blocks_across) * static_cast<std::uint64_t>(blocks_down)),
      above_(static_cast<std::size_t>(blocks_across)), predictions_((above_.size() + 1) / 2), history_(books.history) {}

// Two bits for each of 2x2 blocks.
std::uint32_t BasisSlice::next_predictions() {
    constexpr std::uint32_t kAgain = 256, kLeastRepeats = 3;
    if (repeats_ > 0) {
        --repeats_;
        return last_predictions_;
    }
    const std::uint32_t symbol = books_.prediction.take(bits_);
    if (symbol > kAgain) bits_.fail();
    if (symbol == kAgain)
        repeats_ = std::uint64_t{bits_.take_groups(4)} + kLeastRepeats - 1;
    else
        last_predictions_ = symbol;
    return last_predictions_;
}

std::size_t BasisSlice::next_endpoint(std::uint32_t prediction, std::size_t i, std::size_t above_left_one) {
    switch (prediction) {
        case left: return i > 0 ? last_endpoint_ : kNone;
        case above: return row_ > 0 ? above_[i] : kNone;
        case above_left: return row_ > 0 && i > 0 ? above_left_one : kNone;
        default: {
            const std::size_t endpoint = last_endpoint_ + books_.endpoint_step.take(bits_);
            return endpoint < books_.endpoints.size() ? endpoint : endpoint - books_.endpoints.size();
        }
    }
}

std::size_t BasisSlice::next_selector() {
    constexpr std::uint32_t kLeastRun = 3, kLongRun = 63;
    if (run_ > 0) {
        --run_;
        return history_.use(0);
    }
    const std::size_t symbol = books_.selector.take(bits_);
    if (symbol < books_.selectors.size()) {
        history_.add(static_cast<std::uint16_t>(symbol));
        return symbol;
    }
    const std::size_t k = symbol - books_.selectors.size();
    if (k < history_.size()) return history_.use(k);
    if (k > history_.size()) return kNone;
    const std::uint32_t run = books_.selector_run.take(bits_);
    run_ = std::uint64_t{run == kLongRun ? bits_.take_groups(7) : run} + kLeastRun;
    if (run_ > blocks_) return kNone;
    --run_;
    return history_.use(0);
}

Result<void> BasisSlice::next_row(std::byte* blocks, std::size_t stride) {
    std::uint32_t predictions = 0;
    std::size_t above_left_one = 0;
    for (std::size_t i = 0; i < above_.size(); ++i, blocks += stride, predictions >>= 2) {
        if (i % 2 == 0 && row_ % 2 == 0) {
            predictions = next_predictions();
            predictions_[i / 2] = static_cast<std::uint8_t>(predictions >> 4);
        } else if (i % 2 == 0) {
            predictions = predictions_[i / 2];
        }
        const std::size_t endpoint = next_endpoint(predictions & 3, i, above_left_one);
        if (endpoint >= books_.endpoints.size()) return damaged_basis("a block has endpoints that do not exist");
        above_left_one = above_[i];
        above_[i] = static_cast<std::uint16_t>(endpoint);
        last_endpoint_ = endpoint;
        const std::size_t selector = next_selector();
        if (selector >= books_.selectors.size()) return damaged_basis("a block has selectors that do not exist");
        std::copy_n(books_.endpoints[endpoint].begin(), 4, blocks);
        std::copy_n(books_.selectors[selector].begin(), 4, blocks + 4);
    }
    ++row_;
    return bits_.is_sound() ? Result<void>() : damaged_basis("a slice is damaged or ends too early");
}

}  // namespace tex::inline v1
