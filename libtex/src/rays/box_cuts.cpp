// SPDX-License-Identifier: Apache-2.0

#include "rays/box_cuts.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <new>
#include <utility>

namespace tex::inline v1 {
namespace {

constexpr int kBins = 16;
constexpr std::size_t kMany = 256;

struct Bin {
    FloatBox box;
    std::uint32_t count = 0;
};

// The bins of an axis. Most ranges have fewer triangles than there are bins, so that those without any cost nothing.
class Bins {
public:
    void add(int k, const FloatBox& box) {
        const std::uint32_t bit = 1u << k;
        if ((used_ & bit) == 0) {
            used_ |= bit;
            new (storage_ + static_cast<std::size_t>(k) * sizeof(Bin)) Bin{box, 1};
            return;
        }
        Bin& bin = at(k);
        bin.box.include(box);
        ++bin.count;
    }
    [[nodiscard]] std::uint32_t used() const { return used_; }  // a bit for each bin that is not empty
    [[nodiscard]] Bin& at(int k) { return *std::launder(reinterpret_cast<Bin*>(storage_) + k); }

private:
    alignas(Bin) std::byte storage_[kBins * sizeof(Bin)];
    std::uint32_t used_ = 0;
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
void choose_cut(Bins& bins, int axis, Cut& best) {
    int used[kBins], last = 0;
    for (std::uint32_t left = bins.used(); left != 0; left &= left - 1) used[last++] = std::countr_zero(left);
    float right_cost[kBins];
    FloatBox box;
    std::size_t count = 0;
    for (int n = last - 1; n > 0; --n) {
        const Bin& bin = bins.at(used[n]);
        box.include(bin.box);
        count += bin.count;
        right_cost[n] = box.area() * static_cast<float>(count);
    }
    box = {};
    count = 0;
    for (int n = 0; n < last; ++n) {
        const Bin& bin = bins.at(used[n]);
        if (n > 0) {
            const float cost = box.area() * static_cast<float>(count) + right_cost[n];
            if (cost < best.cost) best = {cost, axis, used[n]};
        }
        box.include(bin.box);
        count += bin.count;
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
    Bins bins[3];
    for (int axis = first_axis; axis <= last_axis; ++axis) {
        const BinScale scale = scales[axis];
        for (std::size_t k = range.begin; k < range.end; ++k) {
            bins[axis].add(scale.bin(boxes[k].center(axis)), boxes[k].box);
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
    for (std::uint32_t used = bins[cut.axis].used(); used != 0; used &= used - 1) {
        const int k = std::countr_zero(used);
        (k < cut.bin ? left : right).box.include(bins[cut.axis].at(k).box);
    }
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
