// SPDX-License-Identifier: Apache-2.0

#include "mesh/weld.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>
#include <utility>

#include "mesh/vectors.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

constexpr int kSlabs = 2048;
constexpr int kPieces = 16;  // of the corners, each counted and moved by one thread

struct PlacedCorner {
    std::array<float, 3> at;
    std::uint32_t corner = 0;
};

struct Box {
    std::array<float, 3> low, high;

    explicit Box(const std::array<float, 3>& p) : low(p), high(p) {}
    void add(const std::array<float, 3>& p) {
        for (std::size_t c = 0; c < 3; ++c) {
            low[c] = p[c] < low[c] ? p[c] : low[c];
            high[c] = p[c] > high[c] ? p[c] : high[c];
        }
    }
    // The axis of the longest side; if sides are equal, as the reference decides.
    [[nodiscard]] std::size_t axis() const {
        const float x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
        if (y > x && y > z) return 1;
        return z > x ? 2 : 0;
    }
};

class Welder {
public:
    Welder(const MeshPart& part, int uv_set)
        : part_(part), uvs_(part.uvs[static_cast<std::size_t>(uv_set)]), representative_(part.indices.size()) {}

    Result<std::vector<std::uint32_t>> run(const Execution& execution);

private:
    using Corners = std::vector<PlacedCorner>;

    [[nodiscard]] std::array<float, 3> at(std::size_t corner) const {
        const Float3& p = part_.positions[part_.indices[corner]];
        return {p.x, p.y, p.z};
    }
    [[nodiscard]] std::uint32_t vertex(const PlacedCorner& c) const { return part_.indices[c.corner]; }
    [[nodiscard]] bool equal(std::uint32_t a, std::uint32_t b) const {
        return a == b || (same(part_.positions[a], part_.positions[b]) && same(part_.normals[a], part_.normals[b]) &&
                          same(uvs_[a], uvs_[b]));
    }
    // The attributes of a vertex, for sorting.
    [[nodiscard]] auto key(std::uint32_t v) const {
        const Float3 &p = part_.positions[v], &n = part_.normals[v];
        return std::make_tuple(p.x, p.y, p.z, n.x, n.y, n.z, uvs_[v].x, uvs_[v].y);
    }
    Result<void> sort_into_slabs(const Execution& execution);
    void divide(PlacedCorner* first, PlacedCorner* last);
    void weld_few(const PlacedCorner* first, const PlacedCorner* last);
    void weld_many(const PlacedCorner* first, const PlacedCorner* last);

    const MeshPart& part_;
    const std::vector<Float2>& uvs_;
    std::vector<std::uint32_t> representative_;
    Corners corners_;
    std::vector<std::size_t> slab_ends_;
};

// Cells of equal width. A mesh without extent has one: there, the quotient is NaN.
int slab_of(float value, float low, float high) {
    const float slab = kSlabs * ((value - low) / (high - low));
    if (!(slab > 0.0f)) return 0;
    return slab < kSlabs ? static_cast<int>(slab) : kSlabs - 1;
}

// A stable counting sort: pieces of the corners are counted, then moved, in parallel.
Result<void> Welder::sort_into_slabs(const Execution& execution) {
    const std::size_t count = part_.indices.size();
    const std::size_t piece = (count + kPieces - 1) / kPieces;
    const auto range = [&](int k) {
        const auto begin = std::min(count, static_cast<std::size_t>(k) * piece);
        return std::pair(begin, std::min(count, begin + piece));
    };
    Box box(at(0));
    for (std::size_t c = 1; c < count; ++c) box.add(at(c));
    const std::size_t axis = box.axis();
    const float low = box.low[axis], high = box.high[axis];

    std::vector<std::array<std::size_t, kSlabs>> next(kPieces);
    std::vector<std::uint16_t> slabs(count);
    const auto counted = parallel_for(execution, kPieces, 1, [&](int begin, int end) {
        for (int k = begin; k < end; ++k) {
            auto& counts = next[static_cast<std::size_t>(k)];
            counts.fill(0);
            for (auto [c, stop] = range(k); c < stop; ++c) {
                const int slab = slab_of(at(c)[axis], low, high);
                slabs[c] = static_cast<std::uint16_t>(slab);
                ++counts[static_cast<std::size_t>(slab)];
            }
        }
    });
    if (!counted) return counted.error();
    slab_ends_.resize(kSlabs);
    std::size_t total = 0;
    for (std::size_t slab = 0; slab < kSlabs; ++slab) {
        for (auto& counts : next) total += std::exchange(counts[slab], total);
        slab_ends_[slab] = total;
    }
    corners_.resize(count);
    return parallel_for(execution, kPieces, 1, [&](int begin, int end) {
        for (int k = begin; k < end; ++k) {
            auto& places = next[static_cast<std::size_t>(k)];
            for (auto [c, stop] = range(k); c < stop; ++c)
                corners_[places[slabs[c]]++] = {at(c), static_cast<std::uint32_t>(c)};
        }
    });
}

// Halves the corners [first, last) at the middle of the longest side of their box, until the middle is no longer inside
// it: then at most neighbouring floats are left. Each half is shorter, so the depth is at most the number of halvings
// of a float in three axes, below 1000. The order in which the halves exchange corners is the reference's.
void Welder::divide(PlacedCorner* first, PlacedCorner* last) {
    while (last - first >= 2) {
        Box box(first->at);
        for (const PlacedCorner* c = first + 1; c != last; ++c) box.add(c->at);
        const std::size_t axis = box.axis();
        const float middle = 0.5f * (box.high[axis] + box.low[axis]);
        if (!(middle < box.high[axis] && middle > box.low[axis])) {
            last - first <= 32 ? weld_few(first, last) : weld_many(first, last);
            return;
        }
        PlacedCorner *left = first, *right = last;
        for (;;) {
            while (left < right && left->at[axis] < middle) ++left;
            while (left < right && !(right[-1].at[axis] < middle)) --right;
            if (left == right) break;
            std::swap(*left++, *--right);
        }
        divide(first, left);
        first = left;
    }
}

// The first of equal corners represents the others.
void Welder::weld_few(const PlacedCorner* first, const PlacedCorner* last) {
    for (const PlacedCorner* c = first; c != last; ++c) {
        const PlacedCorner* other = first;
        while (other != c && !equal(vertex(*other), vertex(*c))) ++other;
        if (other != c) representative_[c->corner] = representative_[other->corner];
    }
}

void Welder::weld_many(const PlacedCorner* first, const PlacedCorner* last) {
    std::vector<const PlacedCorner*> sorted;
    for (const PlacedCorner* c = first; c != last; ++c) sorted.push_back(c);
    std::sort(sorted.begin(), sorted.end(), [&](const PlacedCorner* a, const PlacedCorner* b) {
        const auto key_a = key(vertex(*a)), key_b = key(vertex(*b));
        return key_a != key_b ? key_a < key_b : a < b;
    });
    for (std::size_t k = 1; k < sorted.size(); ++k) {
        if (equal(vertex(*sorted[k - 1]), vertex(*sorted[k])))
            representative_[sorted[k]->corner] = representative_[sorted[k - 1]->corner];
    }
}

Result<std::vector<std::uint32_t>> Welder::run(const Execution& execution) {
    for (std::size_t c = 0; c < representative_.size(); ++c) representative_[c] = static_cast<std::uint32_t>(c);
    if (const auto sorted = sort_into_slabs(execution); !sorted) return sorted.error();
    const auto welded = parallel_for(execution, kSlabs, 8, [&](int begin, int end) {
        for (int k = begin; k < end; ++k) {
            const std::size_t from = k == 0 ? 0 : slab_ends_[static_cast<std::size_t>(k - 1)];
            divide(corners_.data() + from, corners_.data() + slab_ends_[static_cast<std::size_t>(k)]);
        }
    });
    if (!welded) return welded.error();
    return std::move(representative_);
}

}  // namespace

Result<std::vector<std::uint32_t>> weld_corners(const MeshPart& part, int uv_set, const Execution& execution) {
    return Welder(part, uv_set).run(execution);
}

Result<std::vector<std::uint32_t>> weld_to_first(const MeshPart& part, int uv_set, const Execution& execution) {
    auto welded = weld_corners(part, uv_set, execution);
    if (!welded) return welded;
    constexpr std::uint32_t kNone = ~std::uint32_t{0};
    std::vector<std::uint32_t> first(welded->size(), kNone);
    for (std::size_t c = 0; c < welded->size(); ++c) {
        std::uint32_t& corner = (*welded)[c];
        if (first[corner] == kNone) first[corner] = static_cast<std::uint32_t>(c);
        corner = first[corner];
    }
    return welded;
}

std::vector<std::uint32_t> numbered_positions(const MeshPart& part) {
    std::vector<std::uint32_t> order(part.positions.size()), number(order.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto key = [&](std::uint32_t v) {
        const Float3& p = part.positions[v];
        return std::tuple(p.x, p.y, p.z);
    };
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    std::uint32_t last = 0;
    for (std::size_t k = 0; k < order.size(); ++k) {
        if (k > 0 && key(order[k - 1]) != key(order[k])) ++last;
        number[order[k]] = last;
    }
    return number;
}

}  // namespace tex::inline v1
