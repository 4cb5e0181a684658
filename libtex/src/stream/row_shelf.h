// SPDX-License-Identifier: Apache-2.0
// row_shelf.h: the rows of a level that are still needed.
//
// If the texture repeats, its first rows need its last ones, so they are made at the end. Rows then come in the order
//
//     start, start + 1, ..., height - 1, 0, ..., start - 1
//
// at positions start, ..., height - 1, height, ..., height + start - 1.

#pragma once

#include <memory>
#include <vector>

#include <tex/image.h>

#include "kernels/bake.h"
#include "threads/pool.h"

namespace tex {

// The planes of a row, null after the last one, and the object that owns them.
struct ShelfRow {
    const float* planes[4] = {};
    std::shared_ptr<const void> owner;
};

// The rows that stay on a shelf to the end, even though release_before() has passed them.
struct Keep {
    int head = 0;  // the first rows that arrive
    int tail = 0;  // the last rows of the level
    bool all = false;
};

class RowShelf {
public:
    RowShelf(int height, int start, Keep keep);

    void put(int j, ShelfRow row);
    [[nodiscard]] bool has(int j) const { return slots_[static_cast<std::size_t>(j)] >= 0; }
    // Precondition: has(j).
    [[nodiscard]] const ShelfRow& at(int j) const;
    // Rows at positions below `position` are no longer needed, except the rows to keep.
    void release_before(int position);

    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] int start() const { return start_; }

private:
    const int height_;
    const int start_;
    const Keep keep_;
    int released_;            // positions below this one are released
    std::vector<int> slots_;  // index of row j in rows_, or -1
    std::vector<ShelfRow> rows_;
    std::vector<int> free_;
};

// Makes rows that own their memory, padded like the rows of a Plane.
class RowMaker {
public:
    RowMaker(int width, int planes) : extent_{width, planes} {}

    // A row whose values are not set.
    std::shared_ptr<Plane<float>> make() {
        return pool_.take([this] { return std::make_unique<Plane<float>>(extent_); });
    }

private:
    Extent extent_;
    Pool<Plane<float>> pool_;
};

}  // namespace tex
