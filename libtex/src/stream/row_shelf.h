// SPDX-License-Identifier: Apache-2.0
// row_shelf.h: the rows of a level that are still needed.
//
// Where the texture repeats, its first rows need its last ones and are made at the end: rows then come in the order
//
//     start, start + 1, ..., height - 1, 0, ..., start - 1
//
// and have positions start, ..., height - 1, height, ..., height + start - 1.

#pragma once

#include <memory>
#include <vector>

#include <tex/image.h>

#include "kernels/bake.h"
#include "threads/pool.h"

namespace tex {

// The planes of a row, as many as there are, and whoever owns them.
struct ShelfRow {
    const float* planes[4] = {};
    std::shared_ptr<const void> owner;
};

// Which rows stay on a shelf to the end, although release_before() passed them.
struct Keep {
    int head = 0;  // the first ones that come
    int tail = 0;  // the last ones of the level
    bool all = false;
};

class RowShelf {
public:
    RowShelf(int height, int start, Keep keep);

    void put(int j, ShelfRow row);
    [[nodiscard]] bool has(int j) const { return slots_[static_cast<std::size_t>(j)] >= 0; }
    // Precondition: has(j).
    [[nodiscard]] const ShelfRow& at(int j) const;
    // Rows at positions below `position` are not needed any more, except for those that are kept.
    void release_before(int position);

    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] int start() const { return start_; }

private:
    const int height_;
    const int start_;
    const Keep keep_;
    int released_;            // positions below are done with
    std::vector<int> slots_;  // of row j in rows_, or -1
    std::vector<ShelfRow> rows_;
    std::vector<int> free_;
};

// Rows of their own memory, padded as those of a Plane.
class RowMaker {
public:
    RowMaker(int width, int planes) : extent_{width, planes} {}

    // A row with unset values.
    std::shared_ptr<Plane<float>> make() {
        return pool_.take([this] { return std::make_unique<Plane<float>>(extent_); });
    }

private:
    Extent extent_;
    Pool<Plane<float>> pool_;
};

}  // namespace tex
