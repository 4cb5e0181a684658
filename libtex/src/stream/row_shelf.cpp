// SPDX-License-Identifier: Apache-2.0

#include "stream/row_shelf.h"

#include <cassert>
#include <utility>

namespace tex {

RowShelf::RowShelf(int height, int start, Keep keep)
    : height_(height), start_(start), keep_(keep), released_(start), slots_(static_cast<std::size_t>(height), -1) {}

void RowShelf::put(int j, ShelfRow row) {
    assert(!has(j));
    if (free_.empty()) {
        free_.push_back(static_cast<int>(rows_.size()));
        rows_.emplace_back();
    }
    const int slot = free_.back();
    free_.pop_back();
    slots_[static_cast<std::size_t>(j)] = slot;
    rows_[static_cast<std::size_t>(slot)] = std::move(row);
}

const ShelfRow& RowShelf::at(int j) const {
    assert(has(j));
    return rows_[static_cast<std::size_t>(slots_[static_cast<std::size_t>(j)])];
}

void RowShelf::release_before(int position) {
    if (keep_.all) return;
    for (; released_ < position && released_ < height_ + start_; ++released_) {
        const int j = released_ % height_;
        if (released_ - start_ < keep_.head || j >= height_ - keep_.tail || !has(j)) continue;
        int& slot = slots_[static_cast<std::size_t>(j)];
        rows_[static_cast<std::size_t>(slot)] = {};
        free_.push_back(slot);
        slot = -1;
    }
}

}  // namespace tex
