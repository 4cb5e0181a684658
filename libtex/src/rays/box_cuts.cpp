// SPDX-License-Identifier: Apache-2.0

#include "rays/box_cuts.h"

#include <utility>

namespace tex::inline v1 {
namespace {

constexpr int kBins = 16;
constexpr std::size_t kMany = 256;

struct Bin {
    FloatBox box;
    std::uint32_t count = 0;
};

// The bin of a place along an axis.
struct BinScale {
    float first = 0.0f, factor = 0.0f;

    BinScale(float low, float high) : first(low), factor(high > low ? 0.999f * kBins / (high - low) : 0.0f) {}
    [[nodiscard]] int bin(float place) const {
        return std::min(std::max(static_cast<int>((place - first) * factor), 0), kBins - 1);
    }
};

struct Cut {
    float cost = std::numeric_limits<float>::infinity();
    int axis = -1;
    int bin = 0;  // the first one on the right
};

// The cheapest cut of these bins, if it is cheaper than `best`. Before and after an empty bin, a cut costs the same.
void choose_cut(const Bin* bins, int axis, Cut& best) {
    float right_cost[kBins];
    FloatBox box;
    std::size_t count = 0;
    for (int k = kBins - 1; k > 0; --k) {
        if (bins[k].count == 0) continue;
        box.include(bins[k].box);
        count += bins[k].count;
        right_cost[k] = box.area() * static_cast<float>(count);
    }
    box = {};
    count = 0;
    for (int k = 0; k < kBins; ++k) {
        if (bins[k].count == 0) continue;
        if (count > 0) {
            const float cost = box.area() * static_cast<float>(count) + right_cost[k];
            if (cost < best.cost) best = {cost, axis, k};
        }
        box.include(bins[k].box);
        count += bins[k].count;
    }
}

// A box around twice the centres.
FloatBox bounds_of_centers(const BoxedTriangle* boxes, const BoxRange& range) {
    FloatBox bounds;
    for (std::size_t k = range.begin; k < range.end; ++k) {
        for (int axis = 0; axis < 3; ++axis) {
            bounds.low[axis] = std::min(bounds.low[axis], boxes[k].center(axis));
            bounds.high[axis] = std::max(bounds.high[axis], boxes[k].center(axis));
        }
    }
    return bounds;
}

// Around the boxes, twice as large. If there are many, their centres fill nearly all of it.
FloatBox bounds_of_boxes(const BoxRange& range) {
    FloatBox bounds;
    for (int axis = 0; axis < 3; ++axis) {
        bounds.low[axis] = 2.0f * range.box.low[axis];
        bounds.high[axis] = 2.0f * range.box.high[axis];
    }
    return bounds;
}

int longest_axis(const FloatBox& box) {
    int longest = 0;
    for (int axis = 1; axis < 3; ++axis) {
        if (box.high[axis] - box.low[axis] > box.high[longest] - box.low[longest]) longest = axis;
    }
    return longest;
}

// Cuts along these axes, of which `centers` are the bounds. Returns false if all centres are in one bin of each.
bool cut_along(BoxedTriangle* boxes, const BoxRange& range, const FloatBox& centers, int first_axis, int last_axis,
               BoxRange& left, BoxRange& right) {
    const BinScale scales[3] = {
        {centers.low[0], centers.high[0]}, {centers.low[1], centers.high[1]}, {centers.low[2], centers.high[2]}};
    Bin bins[3][kBins];
    for (int axis = first_axis; axis <= last_axis; ++axis) {
        const BinScale scale = scales[axis];
        for (std::size_t k = range.begin; k < range.end; ++k) {
            Bin& bin = bins[axis][scale.bin(boxes[k].center(axis))];
            bin.box.include(boxes[k].box);
            ++bin.count;
        }
    }
    Cut cut;
    for (int axis = first_axis; axis <= last_axis; ++axis) choose_cut(bins[axis], axis, cut);
    if (cut.axis < 0) return false;
    std::size_t first = range.begin, last = range.end;
    while (first < last) {
        if (scales[cut.axis].bin(boxes[first].center(cut.axis)) < cut.bin)
            ++first;
        else
            std::swap(boxes[first], boxes[--last]);
    }
    left = {range.begin, first, {}, range.may_have_copies};
    right = {first, range.end, {}, range.may_have_copies};
    for (int k = 0; k < kBins; ++k) (k < cut.bin ? left : right).box.include(bins[cut.axis][k].box);
    return true;
}

}  // namespace

void halve_range(const BoxedTriangle* boxes, const BoxRange& range, BoxRange& left, BoxRange& right) {
    const std::size_t middle = range.begin + range.count() / 2;
    left = {range.begin, middle, {}, range.may_have_copies};
    right = {middle, range.end, {}, range.may_have_copies};
    for (BoxRange* half : {&left, &right}) {
        for (std::size_t k = half->begin; k < half->end; ++k) half->box.include(boxes[k].box);
    }
}

// Where there are many boxes, the longest axis mostly suffices.
bool cut_range(BoxedTriangle* boxes, const BoxRange& range, BoxRange& left, BoxRange& right) {
    if (range.count() > kMany) {
        const FloatBox bounds = bounds_of_boxes(range);
        const int longest = longest_axis(bounds);
        if (cut_along(boxes, range, bounds, longest, longest, left, right)) return true;
    }
    return cut_along(boxes, range, bounds_of_centers(boxes, range), 0, 2, left, right);
}

}  // namespace tex::inline v1
