// SPDX-License-Identifier: Apache-2.0

#include "rays/box_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "rays/box_cuts.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

// Ranges below this are built by one thread each.
constexpr std::size_t kPiece = 1 << 13;
// Beyond this many levels, ranges are halved by order, so that the depth stays limited.
constexpr int kMostCuts = 32;

struct Piece {
    std::vector<Boxes> boxes;
    std::vector<TriangleGroup> groups;
};

}  // namespace

class TreeBuilder {
public:
    TreeBuilder(const Triangles& triangles, BoxTree& tree) : triangles_(triangles), tree_(tree) {}

    Result<void> run(const Execution& execution, ProgressSpan span);

private:
    struct Job {
        BoxRange range;
        std::uint32_t parent;
        int child;
        int level;
    };

    Result<void> measure(const Execution& execution);
    [[nodiscard]] FloatBox box_of(std::size_t triangle) const;
    void drop_copies(BoxRange& range);
    int children_of(const BoxRange& range, int level, BoxRange* children);
    Result<void> box_triangles(const Execution& execution);
    Result<void> build_top(const Execution& execution);
    std::uint32_t build(const BoxRange& range, int level, Piece& piece);
    std::uint32_t add_group(const BoxRange& range, std::vector<TriangleGroup>& groups);
    void join(const std::vector<Piece>& pieces, const std::vector<std::uint32_t>& roots);

    const Triangles& triangles_;
    BoxTree& tree_;
    std::vector<BoxedTriangle> boxed_;
    std::vector<Job> jobs_;  // ranges below kPiece
};

// The box of all triangles, and the power of two that brings it into [-1, 1].
Result<void> TreeBuilder::measure(const Execution& execution) {
    constexpr int kGrain = 1 << 16;
    FloatBox all;
    for (const MeshPart* part : triangles_.parts()) {
        const auto count = static_cast<int>(part->indices.size());
        std::vector<FloatBox> pieces(static_cast<std::size_t>((count + kGrain - 1) / kGrain));
        const auto measure_piece = [&](int begin, int end) {
            FloatBox box;
            for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
                const Float3& p = part->positions[part->indices[k]];
                box.include({{p.x, p.y, p.z}, {p.x, p.y, p.z}});
            }
            pieces[static_cast<std::size_t>(begin / kGrain)] = box;
        };
        if (auto done = parallel_for(execution.quiet(), count, kGrain, measure_piece); !done) return done;
        for (const FloatBox& box : pieces) all.include(box);
    }
    tree_.set_bounds(all);
    return {};
}

FloatBox TreeBuilder::box_of(std::size_t triangle) const {
    FloatBox box;
    for (const Vector3& corner : triangles_.at(triangle).stored_corners()) {
        const Vector3 p = tree_.scale_ * (corner - tree_.center_);
        const float at[3] = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
        for (int k = 0; k < 3; ++k) {
            box.low[k] = std::min(box.low[k], at[k]);
            box.high[k] = std::max(box.high[k], at[k]);
        }
    }
    return box;
}

Result<void> TreeBuilder::box_triangles(const Execution& execution) {
    boxed_.resize(triangles_.count());
    const auto fill = [this](int begin, int end) {
        for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k)
            boxed_[k] = {box_of(k), static_cast<std::uint32_t>(k)};
    };
    return parallel_for(execution.quiet(), static_cast<int>(boxed_.size()), 1 << 14, fill);
}

// Takes triangles out of the range whose corners are those of another one, bit for bit and in the same order. The first
// triangle stays, whose hit wins. Copies have the same centre, so that cuts leave them together.
void TreeBuilder::drop_copies(BoxRange& range) {
    struct Place {
        std::array<std::uint32_t, 9> corners{};  // the bits of their coordinates
        BoxedTriangle boxed;
    };
    std::vector<Place> places(range.count());
    for (std::size_t k = 0; k < places.size(); ++k) {
        places[k].boxed = boxed_[range.begin + k];
        const Triangles::Triangle triangle = triangles_.at(places[k].boxed.triangle);
        for (std::size_t c = 0; c < 3; ++c) {
            const Float3& p = triangle.part.positions[triangle.stored_vertex(c)];
            std::memcpy(&places[k].corners[3 * c], &p, sizeof p);
        }
    }
    std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
        return a.corners != b.corners ? a.corners < b.corners : a.boxed.triangle < b.boxed.triangle;
    });
    const auto end = std::unique(places.begin(), places.end(),
                                 [](const Place& a, const Place& b) { return a.corners == b.corners; });
    range.end = range.begin;
    for (auto place = places.begin(); place != end; ++place) boxed_[range.end++] = place->boxed;
    range.may_have_copies = false;
}

// Cuts a range into up to eight, always the largest one. Returns their number.
int TreeBuilder::children_of(const BoxRange& range, int level, BoxRange* children) {
    children[0] = range;
    int count = 1;
    while (count < kBoxes) {
        int largest = -1;
        float area = -1.0f;
        for (int k = 0; k < count; ++k) {
            if (children[k].count() <= kGroupTriangles || children[k].box.area() <= area) continue;
            largest = k;
            area = children[k].box.area();
        }
        if (largest < 0) break;
        BoxRange& parent = children[largest];
        BoxRange left, right;
        if (level > kMostCuts || !cut_range(boxed_.data(), parent, left, right)) {
            if (level <= kMostCuts && parent.may_have_copies) drop_copies(parent);
            if (parent.count() <= kGroupTriangles) continue;
            halve_range(boxed_.data(), parent, left, right);
        }
        parent = left;
        children[count++] = right;
    }
    return count;
}

// The levels above the pieces, one after the other: all ranges of a level at once.
Result<void> TreeBuilder::build_top(const Execution& execution) {
    struct Wide {
        Job job;
        BoxRange children[kBoxes];
        int count = 0;
    };
    BoxRange all{0, boxed_.size(), {}};
    for (const BoxedTriangle& triangle : boxed_) all.box.include(triangle.box);
    std::vector<Wide> level = {{{all, 0, -1, 0}, {}, 0}};
    while (!level.empty()) {
        const auto cut = [&](int begin, int end) {
            for (int k = begin; k < end; ++k) {
                Wide& wide = level[static_cast<std::size_t>(k)];
                wide.count = children_of(wide.job.range, wide.job.level, wide.children);
            }
        };
        if (auto done = parallel_for(execution.quiet(), static_cast<int>(level.size()), 1, cut); !done) return done;
        std::vector<Wide> next;
        for (const Wide& wide : level) {
            const auto index = static_cast<std::uint32_t>(tree_.boxes_.size());
            if (wide.job.child >= 0) tree_.boxes_[wide.job.parent].child[wide.job.child] = index;
            tree_.boxes_.push_back(no_boxes());
            for (int k = 0; k < wide.count; ++k) {
                set_box(tree_.boxes_.back(), k, wide.children[k].box);
                const Job job{wide.children[k], index, k, wide.job.level + 1};
                if (job.range.count() > kPiece)
                    next.push_back({job, {}, 0});
                else
                    jobs_.push_back(job);
            }
        }
        level = std::move(next);
    }
    return {};
}

std::uint32_t TreeBuilder::add_group(const BoxRange& range, std::vector<TriangleGroup>& groups) {
    TriangleGroup group;
    for (auto& corner : group.at) {
        for (auto& axis : corner) std::fill_n(axis, kGroupTriangles, std::numeric_limits<float>::quiet_NaN());
    }
    std::fill_n(group.triangle, kGroupTriangles, kNoHit);
    for (std::size_t k = 0; k < range.count(); ++k) {
        const std::uint32_t triangle = boxed_[range.begin + k].triangle;
        const Triangles::Triangle place = triangles_.at(triangle);
        for (std::size_t c = 0; c < 3; ++c) {
            const Float3& p = place.part.positions[place.stored_vertex(c)];
            group.at[c][0][k] = p.x;
            group.at[c][1][k] = p.y;
            group.at[c][2][k] = p.z;
        }
        group.triangle[k] = triangle;
    }
    groups.push_back(group);
    return static_cast<std::uint32_t>(groups.size() - 1) | kGroupBit;
}

// Indices are those of the piece. No deeper than kMostLevels: a level that halves by order halves the largest count,
// and there are at most 2^28 triangles.
std::uint32_t TreeBuilder::build(const BoxRange& range, int level, Piece& piece) {
    if (range.count() <= kGroupTriangles) return add_group(range, piece.groups);
    BoxRange children[kBoxes];
    const int count = children_of(range, level, children);
    const std::size_t index = piece.boxes.size();
    piece.boxes.push_back(no_boxes());
    for (int k = 0; k < count; ++k) {
        set_box(piece.boxes[index], k, children[k].box);
        const std::uint32_t child = build(children[k], level + 1, piece);
        piece.boxes[index].child[k] = child;
    }
    return static_cast<std::uint32_t>(index);
}

void TreeBuilder::join(const std::vector<Piece>& pieces, const std::vector<std::uint32_t>& roots) {
    std::size_t boxes = tree_.boxes_.size(), groups = 0;
    for (const Piece& piece : pieces) {
        boxes += piece.boxes.size();
        groups += piece.groups.size();
    }
    tree_.boxes_.reserve(boxes);
    tree_.groups_.reserve(groups);
    for (std::size_t k = 0; k < pieces.size(); ++k) {
        const auto first_box = static_cast<std::uint32_t>(tree_.boxes_.size());
        const auto first_group = static_cast<std::uint32_t>(tree_.groups_.size());
        const auto moved = [&](std::uint32_t child) {
            return child + ((child & kGroupBit) != 0 ? first_group : first_box);
        };
        tree_.boxes_[jobs_[k].parent].child[jobs_[k].child] = moved(roots[k]);
        for (Boxes copy : pieces[k].boxes) {
            for (std::uint32_t& child : copy.child) child = moved(child);
            tree_.boxes_.push_back(copy);
        }
        tree_.groups_.insert(tree_.groups_.end(), pieces[k].groups.begin(), pieces[k].groups.end());
    }
}

Result<void> TreeBuilder::run(const Execution& execution, ProgressSpan span) {
    if (auto measured = measure(execution); !measured) return measured;
    if (auto boxed = box_triangles(execution); !boxed) return boxed;
    if (auto built = build_top(execution); !built) return built;
    std::vector<Piece> pieces(jobs_.size());
    std::vector<std::uint32_t> roots(jobs_.size());
    const auto build_pieces = [&](int begin, int end) {
        for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k)
            roots[k] = build(jobs_[k].range, jobs_[k].level, pieces[k]);
    };
    if (auto built = parallel_for(execution, static_cast<int>(jobs_.size()), 1, build_pieces, span); !built)
        return built;
    std::vector<BoxedTriangle>().swap(boxed_);
    join(pieces, roots);
    return {};
}

void BoxTree::set_bounds(const FloatBox& all) {
    const Vector3 low = vector_of(Float3{all.low[0], all.low[1], all.low[2]}),
                  high = vector_of(Float3{all.high[0], all.high[1], all.high[2]});
    low_ = low;
    high_ = high;
    center_ = 0.5 * (low + high);
    const double half = 0.5 * std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    int exponent = 0;
    if (half > 0.0) std::frexp(half, &exponent);
    scale_ = std::ldexp(1.0, -exponent);
}

double BoxTree::largest_coordinate() const {
    return std::max({std::abs(low_.x), std::abs(low_.y), std::abs(low_.z), std::abs(high_.x), std::abs(high_.y),
                     std::abs(high_.z)});
}

Result<BoxTree> BoxTree::build(const Triangles& triangles, const Execution& execution, ProgressSpan span) {
    return no_throw([&]() -> Result<BoxTree> {
        BoxTree tree;
        if (const auto built = TreeBuilder(triangles, tree).run(execution, span); !built) return built.error();
        return tree;
    });
}

TreeView BoxTree::view() const {
    return {boxes_.data(),
            groups_.data(),
            {center_.x, center_.y, center_.z},
            scale_,
            places_.empty() ? nullptr : places_.data()};
}

}  // namespace tex::inline v1
