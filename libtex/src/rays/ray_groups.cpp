// SPDX-License-Identifier: Apache-2.0

#include "rays/ray_groups.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "rays/part_trees.h"
#include "rows/usable.h"

namespace tex::inline v1 {
namespace {

// The numbers that both meshes have, each once, or 0 if there are none.
std::vector<int> common_numbers(const TransferInputs& inputs) {
    if (inputs.high_groups.empty()) return {0};
    std::vector<int> low = inputs.low_groups, high = inputs.high_groups, both;
    std::sort(low.begin(), low.end());
    std::sort(high.begin(), high.end());
    std::set_intersection(low.begin(), low.end(), high.begin(), high.end(), std::back_inserter(both));
    both.erase(std::unique(both.begin(), both.end()), both.end());
    return both;
}

}  // namespace

// Parts that stand where they are stored, and nowhere else, have no placement.
Result<void> RayGroups::place(const std::vector<MeshPart>& high, const TransferInputs& inputs) {
    std::vector<std::size_t> counts(high.size());
    for (const PartPlace& place : inputs.high_places) ++counts[place.part];
    placements_.reserve(inputs.high_places.size());  // pointers stay good
    for (std::size_t k = 0; k < inputs.high_places.size(); ++k) {
        const PartPlace& place = inputs.high_places[k];
        auto placement = NodeTransform::make(place.name, place.to_scene);
        if (!placement) return placement.error();
        StandingPart standing{&high[place.part], nullptr, k};
        if (counts[place.part] > 1 || !placement->is_identity())
            standing.placement = &placements_.emplace_back(*placement);
        places_.push_back(standing);
    }
    return {};
}

// Takes those with a number, or all of them.
Triangles RayGroups::triangles_of(const std::vector<MeshPart>& high, const std::vector<int>& numbers,
                                  int number) const {
    const auto belongs = [&](std::size_t k) { return numbers.empty() || numbers[k] == number; };
    std::vector<const MeshPart*> parts;
    std::vector<StandingPart> places;
    for (std::size_t k = 0; k < places_.size(); ++k) {
        if (belongs(k)) places.push_back(places_[k]);
    }
    if (!places_.empty()) return Triangles(std::move(places));
    for (std::size_t k = 0; k < high.size(); ++k) {
        if (belongs(k)) parts.push_back(&high[k]);
    }
    return Triangles(std::move(parts));
}

Result<RayGroups> RayGroups::make(const MeshPart& low, const std::vector<MeshPart>& high, const TransferInputs& inputs,
                                  bool whole, const Execution& execution, ProgressSpan span) {
    std::size_t stored = 0;
    for (const MeshPart& part : high) stored += part.triangles();
    if (stored == 0) return Error{ErrorCode::bad_option, {}, "the high mesh is empty"};
    if (stored > kMaxTriangles) return Error{ErrorCode::unsupported, {}, "the high mesh has more than 2^28 triangles"};
    const std::vector<int> numbers = common_numbers(inputs);
    if (numbers.empty()) return bad_option("no part of the high mesh belongs to one of the low mesh");
    RayGroups made;
    if (auto placed = made.place(high, inputs); !placed) return placed.error();
    std::size_t count = made.places_.empty() ? stored : 0;
    for (const StandingPart& place : made.places_) count += place.part->triangles();
    if (count >= kNoHit)
        return Error{ErrorCode::unsupported, {}, "the high mesh has more than 2^32 - 2 triangles in all its places"};
    PartTrees shared;
    const auto build = [&](const Triangles& triangles, const Execution& with, ProgressSpan part) {
        return made.places_.empty() ? BoxTree::build(triangles, with, part)
                                    : BoxTree::build_places(triangles, shared, with, part);
    };
    const Execution quiet = execution.quiet();
    for (const int number : numbers) {
        Triangles triangles = made.triangles_of(high, inputs.high_groups, number);
        auto tree = numbers.size() == 1 ? build(triangles, execution, span) : build(triangles, quiet, {});
        if (!tree) return tree.error();
        made.groups_.push_back(RayGroup{number, std::move(triangles), std::move(*tree)});
    }
    for (std::size_t t = 0; t < low.triangles() && !inputs.low_groups.empty(); ++t) {
        const auto found = std::lower_bound(numbers.begin(), numbers.end(), inputs.low_groups[t]);
        const bool has_group = found != numbers.end() && *found == inputs.low_groups[t];
        made.of_low_.push_back(has_group ? static_cast<int>(found - numbers.begin()) : kNone);
    }
    if (whole && made.groups_.front().triangles.count() != count) {
        Triangles triangles = made.triangles_of(high, {}, 0);
        auto tree = build(triangles, quiet, {});
        if (!tree) return tree.error();
        made.whole_.emplace(RayGroup{kNone, std::move(triangles), std::move(*tree)});
    }
    return made;
}

}  // namespace tex::inline v1
