// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "rays/box_cuts.h"
#include "rays/box_tree.h"
#include "rays/part_trees.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

// Beyond this many levels, ranges are halved by order.
constexpr int kMostPlaceCuts = 32;
// A float is rounded by less than this part of it, and one next to 0 by less than that.
constexpr double kFloatRounding = 0x1p-23, kLeastFloat = 0x1p-148;
// What double loses between both spaces, as a part of the largest number on the way.
constexpr double kWayRounding = 0x1p-46;

std::vector<Float3> used_corners(const MeshPart& part) {
    std::vector<bool> is_used(part.positions.size());
    for (const std::uint32_t v : part.indices) is_used[v] = true;
    std::vector<Float3> corners;
    for (std::size_t v = 0; v < is_used.size(); ++v) {
        if (is_used[v]) corners.push_back(part.positions[v]);
    }
    return corners;
}

FloatBox box_at(Vector3 p) {
    const auto x = static_cast<float>(p.x), y = static_cast<float>(p.y), z = static_cast<float>(p.z);
    return {{x, y, z}, {x, y, z}};
}

// The box of all corners where they stand. What is infinite is in it, too.
FloatBox box_of(const std::vector<Float3>& corners, const NodeTransform& placement) {
    FloatBox box;
    for (const Float3& corner : corners) {
        const Float3 p = placement.position(corner);
        box.include({{p.x, p.y, p.z}, {p.x, p.y, p.z}});
    }
    return box;
}

bool is_finite(const FloatBox& box) {
    const auto is = [](float value) { return std::isfinite(value); };
    return std::all_of(box.low, box.low + 3, is) && std::all_of(box.high, box.high + 3, is);
}

double largest(double a, double b) { return std::max(std::abs(a), std::abs(b)); }

// How far rounding moves a corner, in the space of the mesh: that of corners to float in the scene, which the inverse
// makes larger or smaller; that of the inverse itself; and that of sums in double. Not a number if the inverse is not.
void set_slack(const BoxTree& tree, const NodeTransform& placement, const FloatBox& scene, PlacedTree& place) {
    const NodeTransform::Rows &m = placement.linear(), inverse = placement.inverse();
    const std::array<double, 3> shift = placement.shift();
    const double of_mesh[3] = {largest(tree.low().x, tree.high().x), largest(tree.low().y, tree.high().y),
                               largest(tree.low().z, tree.high().z)};
    for (std::size_t k = 0; k < 3; ++k) {
        double slack = 0.0;
        for (std::size_t j = 0; j < 3; ++j) {
            double product = k == j ? -1.0 : 0.0, size = 0.0;
            for (std::size_t i = 0; i < 3; ++i) {
                product += inverse[k][i] * m[i][j];
                size += std::abs(inverse[k][i] * m[i][j]);
            }
            slack += (std::abs(product) + kWayRounding * size) * of_mesh[j];
            const double of_scene = largest(static_cast<double>(scene.low[j]), static_cast<double>(scene.high[j]));
            slack += std::abs(inverse[k][j]) *
                     (kFloatRounding * of_scene + kLeastFloat + kWayRounding * (std::abs(shift[j]) + of_scene));
            place.to_mesh[k][j] = inverse[k][j];
            place.to_scene[k][j] = m[k][j];
        }
        place.to_scene[k][3] = shift[k];
        place.slack[k] = slack;
    }
}

}  // namespace

Result<std::shared_ptr<const PartTree>> PartTrees::tree_of(const MeshPart& part, const Execution& execution) {
    std::shared_ptr<const PartTree>& kept = trees_[&part];
    if (kept) return kept;
    auto tree = BoxTree::build(Triangles({&part}), execution);
    if (!tree) return tree.error();
    kept = std::make_shared<const PartTree>(PartTree{std::move(*tree), used_corners(part)});
    return kept;
}

class PlaceBuilder {
public:
    PlaceBuilder(const Triangles& triangles, PartTrees& shared, BoxTree& tree)
        : triangles_(triangles), shared_(shared), tree_(tree) {}

    Result<void> run(const Execution& execution, ProgressSpan span);

private:
    void sort_places();
    Result<void> add_plain(const Execution& execution);
    Result<void> add_moved(const Execution& execution, ProgressSpan span);
    void place(std::size_t number, const PartTree& part, PlacedTree& placed, FloatBox& box) const;
    std::uint32_t build(const BoxRange& range, int level);

    const Triangles& triangles_;
    PartTrees& shared_;
    BoxTree& tree_;
    std::vector<std::size_t> plain_, moved_;  // places
    std::vector<FloatBox> scene_;             // of tree_.places_
    std::vector<BoxedTriangle> boxed_;        // places
};

// Parts that stand where they are stored, and in no other place, are one tree. Of places that are equal in all, rays
// would hit the first.
void PlaceBuilder::sort_places() {
    std::map<const MeshPart*, std::size_t> counts;
    for (const StandingPart& standing : triangles_.places()) ++counts[standing.part];
    using Key = std::pair<const MeshPart*, std::array<double, 12>>;
    std::set<Key> seen;
    for (std::size_t k = 0; k < triangles_.places().size(); ++k) {
        const StandingPart& standing = triangles_.places()[k];
        if (standing.placement == nullptr) {
            plain_.push_back(k);
            continue;
        }
        Key key{standing.part, {}};
        if (counts[standing.part] > 1) {
            for (std::size_t i = 0; i < 3; ++i) {
                std::copy_n(standing.placement->linear()[i].begin(), 3, key.second.begin() + 3 * i);
                key.second[9 + i] = standing.placement->shift()[i];
            }
            if (!seen.insert(key).second) continue;
        }
        moved_.push_back(k);
    }
}

Result<void> PlaceBuilder::add_plain(const Execution& execution) {
    if (plain_.empty()) return {};
    std::vector<const MeshPart*> parts;
    for (const std::size_t k : plain_) parts.push_back(triangles_.parts()[k]);
    const Triangles triangles(parts);
    auto built = BoxTree::build(triangles, execution);
    if (!built) return built.error();
    for (TriangleGroup& group : built->groups_) {
        for (std::uint32_t& triangle : group.triangle) {
            if (triangle == kNoHit) continue;
            const std::size_t part = triangles.part_of(triangle);
            triangle =
                static_cast<std::uint32_t>(triangle - triangles.first_of(part) + triangles_.first_of(plain_[part]));
        }
    }
    PlacedTree placed{};
    placed.tree = built->view();
    placed.is_plain = true;
    FloatBox box = box_at(built->low());
    box.include(box_at(built->high()));
    tree_.places_.push_back(placed);
    tree_.below_.push_back(std::make_shared<const BoxTree>(std::move(*built)));
    scene_.push_back(box);
    return {};
}

void PlaceBuilder::place(std::size_t number, const PartTree& part, PlacedTree& placed, FloatBox& box) const {
    const NodeTransform& placement = *triangles_.places()[number].placement;
    box = box_of(part.corners, placement);
    placed = {};
    placed.tree = part.tree.view();
    placed.first = static_cast<std::uint32_t>(triangles_.first_of(number));
    placed.is_mirrored = placement.is_mirrored();
    set_slack(part.tree, placement, box, placed);
}

Result<void> PlaceBuilder::add_moved(const Execution& execution, ProgressSpan span) {
    std::vector<std::shared_ptr<const PartTree>> parts;
    for (const std::size_t k : moved_) {
        auto part = shared_.tree_of(*triangles_.parts()[k], execution.quiet());
        if (!part) return part.error();
        if (parts.empty() || parts.back() != *part) tree_.below_.push_back({*part, &(*part)->tree});
        parts.push_back(std::move(*part));
    }
    const std::size_t first = tree_.places_.size();
    tree_.places_.resize(first + moved_.size());
    scene_.resize(tree_.places_.size());
    const auto place_some = [&](int begin, int end) {
        for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k)
            place(moved_[k], *parts[k], tree_.places_[first + k], scene_[first + k]);
    };
    const auto count = static_cast<int>(moved_.size());
    if (auto done = parallel_for(execution, count, 1, place_some, span); !done) return done;
    if (!std::all_of(scene_.begin(), scene_.end(), is_finite))
        return Error{ErrorCode::bad_data, {}, "a place of the high mesh makes infinite coordinates"};
    return {};
}

// Each leaf is one place. No deeper than kMostLevels: see TreeBuilder.
std::uint32_t PlaceBuilder::build(const BoxRange& range, int level) {
    if (range.count() == 1) return boxed_[range.begin].triangle | kGroupBit;
    BoxRange children[kBoxes] = {range};
    int count = 1;
    for (; count < kBoxes; ++count) {
        int largest = -1;
        for (int k = 0; k < count; ++k) {
            const bool is_larger = largest < 0 || children[k].box.area() > children[largest].box.area();
            if (children[k].count() > 1 && is_larger) largest = k;
        }
        if (largest < 0) break;
        BoxRange left, right;
        if (level > kMostPlaceCuts || !cut_range(boxed_.data(), children[largest], left, right))
            halve_range(boxed_.data(), children[largest], left, right);
        children[largest] = left;
        children[count] = right;
    }
    const std::size_t index = tree_.boxes_.size();
    tree_.boxes_.push_back(no_boxes());
    for (int k = 0; k < count; ++k) {
        set_box(tree_.boxes_[index], k, children[k].box);
        const std::uint32_t child = build(children[k], level + 1);
        tree_.boxes_[index].child[k] = child;
    }
    return static_cast<std::uint32_t>(index);
}

Result<void> PlaceBuilder::run(const Execution& execution, ProgressSpan span) {
    sort_places();
    if (auto added = add_plain(execution.quiet()); !added) return added;
    if (auto added = add_moved(execution, span); !added) return added;
    FloatBox all;
    for (const FloatBox& box : scene_) all.include(box);
    tree_.set_bounds(all);
    BoxRange range{0, scene_.size(), {}};
    for (std::size_t k = 0; k < scene_.size(); ++k) {
        const FloatBox& box = scene_[k];
        BoxedTriangle boxed{{}, static_cast<std::uint32_t>(k)};
        for (const float* corner : {box.low, box.high}) {
            const Vector3 p = tree_.scale_ * (vector_of(Float3{corner[0], corner[1], corner[2]}) - tree_.center_);
            boxed.box.include(box_at(p));
        }
        range.box.include(boxed.box);
        boxed_.push_back(boxed);
    }
    if (boxed_.size() > 1) {
        build(range, 0);
        return {};
    }
    // The first box is no place.
    tree_.boxes_.push_back(no_boxes());
    set_box(tree_.boxes_.front(), 0, range.box);
    tree_.boxes_.front().child[0] = kGroupBit;
    return {};
}

Result<BoxTree> BoxTree::build_places(const Triangles& triangles, PartTrees& shared, const Execution& execution,
                                      ProgressSpan span) {
    return no_throw([&]() -> Result<BoxTree> {
        BoxTree tree;
        if (const auto built = PlaceBuilder(triangles, shared, tree).run(execution, span); !built) return built.error();
        return tree;
    });
}

}  // namespace tex::inline v1
