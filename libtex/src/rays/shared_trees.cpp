// SPDX-License-Identifier: Apache-2.0

#include "rays/shared_trees.h"

#include <algorithm>

#include "threads/no_throw.h"

namespace tex::inline v1 {

std::shared_ptr<SharedTrees> SharedTrees::take(const std::shared_ptr<SharedTrees>& trees) {
    if (trees == nullptr || trees->is_taken_.exchange(true)) return share_trees();
    return {trees.get(), [trees](SharedTrees* taken) { taken->is_taken_ = false; }};
}

void SharedTrees::forget() {
    kept_.clear();
    parts_.clear();
    given_.clear();
    places_.clear();
    placements_.clear();
    trees_ = PartTrees();
    count_ = 0;
}

std::vector<SharedTrees::KnownPart> SharedTrees::known_parts(const std::vector<MeshPart>& high) {
    std::vector<KnownPart> parts;
    parts.reserve(high.size());
    for (const MeshPart& part : high)
        parts.push_back(
            {&part, part.positions.data(), part.indices.data(), part.positions.size(), part.indices.size()});
    return parts;
}

bool SharedTrees::is_of(const std::vector<KnownPart>& parts, const std::vector<PartPlace>& places) const {
    const auto same = [](const PartPlace& a, const PartPlace& b) {
        return a.part == b.part && a.to_scene == b.to_scene;
    };
    return parts == parts_ && std::equal(places.begin(), places.end(), given_.begin(), given_.end(), same);
}

// Parts that stand where they are stored, and nowhere else, have no placement.
Result<void> SharedTrees::set(const std::vector<MeshPart>& high, const std::vector<PartPlace>& places) {
    std::vector<KnownPart> parts = known_parts(high);
    if (is_of(parts, places)) return {};
    forget();
    std::vector<std::size_t> counts(high.size());
    for (const PartPlace& place : places) ++counts[place.part];
    placements_.reserve(places.size());  // pointers stay good
    for (std::size_t k = 0; k < places.size(); ++k) {
        const PartPlace& place = places[k];
        auto placement = NodeTransform::make(place.name, place.to_scene);
        if (!placement) return placement.error();
        StandingPart standing{&high[place.part], nullptr, k};
        if (counts[place.part] > 1 || !placement->is_identity())
            standing.placement = &placements_.emplace_back(*placement);
        places_.push_back(standing);
        count_ += standing.part->triangles();
    }
    for (std::size_t k = 0; k < high.size() && places.empty(); ++k) count_ += high[k].triangles();
    given_ = places;
    parts_ = std::move(parts);  // now it is of this mesh
    return {};
}

Triangles SharedTrees::triangles_of(const std::vector<std::size_t>& numbers) const {
    std::vector<StandingPart> places;
    for (const std::size_t k : numbers) {
        if (!places_.empty()) places.push_back(places_[k]);
    }
    if (!places_.empty()) return Triangles(std::move(places));
    std::vector<const MeshPart*> parts;
    for (const std::size_t k : numbers) parts.push_back(parts_[k].part);
    return Triangles(std::move(parts));
}

// What was used longest ago goes first.
Result<std::shared_ptr<const RayTarget>> SharedTrees::tree_of(const std::vector<std::size_t>& numbers,
                                                              const Execution& execution, ProgressSpan span) {
    const auto known =
        std::find_if(kept_.begin(), kept_.end(), [&](const Kept& kept) { return kept.numbers == numbers; });
    if (known != kept_.end()) {
        kept_.splice(kept_.end(), kept_, known);
        return kept_.back().target;
    }
    Triangles triangles = triangles_of(numbers);
    auto tree = places_.empty() ? BoxTree::build(triangles, execution, span)
                                : BoxTree::build_places(triangles, trees_, execution, span);
    if (!tree) return tree.error();
    kept_.push_back({numbers, std::make_shared<const RayTarget>(RayTarget{std::move(triangles), std::move(*tree)})});
    std::size_t sum = 0;
    for (const Kept& kept : kept_) sum += kept.target->triangles.count();
    const std::shared_ptr<const RayTarget> target = kept_.back().target;
    for (; sum > 2 * count_ && kept_.size() > 1; kept_.pop_front()) sum -= kept_.front().target->triangles.count();
    return target;
}

std::shared_ptr<SharedTrees> share_trees() { return std::make_shared<SharedTrees>(); }

}  // namespace tex::inline v1
