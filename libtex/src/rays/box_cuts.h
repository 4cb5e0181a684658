// SPDX-License-Identifier: Apache-2.0
// box_cuts.h: cuts a list of boxes in two.

#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "kernels/trace.h"

namespace tex::inline v1 {

struct FloatBox {
    float low[3] = {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity(),
                    std::numeric_limits<float>::infinity()};
    float high[3] = {-std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(),
                     -std::numeric_limits<float>::infinity()};

    void include(const FloatBox& box) {
        for (int k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], box.low[k]);
            high[k] = std::max(high[k], box.high[k]);
        }
    }
    // Half of the surface.
    [[nodiscard]] float area() const {
        const float x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
        return x * y + (y + x) * z;
    }
};

// A box without children.
inline Boxes no_boxes() {
    Boxes boxes;
    for (int k = 0; k < kBoxes; ++k) {
        for (int axis = 0; axis < 3; ++axis) {
            boxes.low[axis][k] = std::numeric_limits<float>::infinity();
            boxes.high[axis][k] = -std::numeric_limits<float>::infinity();
        }
        boxes.child[k] = kGroupBit;
    }
    return boxes;
}

inline void set_box(Boxes& boxes, int k, const FloatBox& box) {
    for (int axis = 0; axis < 3; ++axis) {
        boxes.low[axis][k] = box.low[axis];
        boxes.high[axis][k] = box.high[axis];
    }
}

struct BoxedTriangle {
    FloatBox box;
    std::uint32_t triangle;

    // Twice the centre.
    [[nodiscard]] float center(int axis) const { return box.low[axis] + box.high[axis]; }
};

// A piece of the list, and the box around it.
struct BoxRange {
    std::size_t begin = 0, end = 0;
    FloatBox box;
    bool may_have_copies = true;

    [[nodiscard]] std::size_t count() const { return end - begin; }
};

// Sorts the range into two, neither of which is empty. Returns false, and does nothing, if all boxes have the same
// centre.
bool cut_range(BoxedTriangle* boxes, const BoxRange& range, BoxRange& left, BoxRange& right);

// Both halves have the same number of boxes. Precondition: there are at least two.
void halve_range(const BoxedTriangle* boxes, const BoxRange& range, BoxRange& left, BoxRange& right);

}  // namespace tex::inline v1
