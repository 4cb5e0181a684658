// SPDX-License-Identifier: Apache-2.0

#include "rays/ray_groups.h"

#include <algorithm>
#include <iterator>
#include <utility>

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

// The parts or places with a number, or all of them.
std::vector<std::size_t> chosen(std::size_t count, const std::vector<int>& numbers, int number) {
    std::vector<std::size_t> chosen;
    for (std::size_t k = 0; k < count; ++k) {
        if (numbers.empty() || numbers[k] == number) chosen.push_back(k);
    }
    return chosen;
}

}  // namespace

Result<RayGroups> RayGroups::make(const MeshPart& low, const std::vector<MeshPart>& high, const TransferInputs& inputs,
                                  bool whole, const Execution& execution, ProgressSpan span) {
    std::size_t stored = 0;
    for (const MeshPart& part : high) stored += part.triangles();
    if (stored == 0) return Error{ErrorCode::bad_option, {}, "the high mesh is empty"};
    if (stored > kMaxTriangles) return Error{ErrorCode::unsupported, {}, "the high mesh has more than 2^28 triangles"};
    const std::vector<int> numbers = common_numbers(inputs);
    if (numbers.empty()) return bad_option("no part of the high mesh belongs to one of the low mesh");
    RayGroups made;
    made.trees_ = SharedTrees::take(inputs.trees);
    SharedTrees& trees = *made.trees_;
    if (auto set = trees.set(high, inputs.high_places); !set) return set.error();
    if (trees.triangles() >= kNoHit)
        return Error{ErrorCode::unsupported, {}, "the high mesh has more than 2^32 - 2 triangles in all its places"};
    const Execution quiet = execution.quiet();
    const bool is_one = numbers.size() == 1;
    for (const int number : numbers) {
        auto target = trees.tree_of(chosen(trees.standing(), inputs.high_groups, number), is_one ? execution : quiet,
                                    is_one ? span : ProgressSpan{});
        if (!target) return target.error();
        made.groups_.push_back(RayGroup{number, std::move(*target)});
    }
    for (std::size_t t = 0; t < low.triangles() && !inputs.low_groups.empty(); ++t) {
        const auto found = std::lower_bound(numbers.begin(), numbers.end(), inputs.low_groups[t]);
        const bool has_group = found != numbers.end() && *found == inputs.low_groups[t];
        made.of_low_.push_back(has_group ? static_cast<int>(found - numbers.begin()) : kNone);
    }
    if (whole && made.groups_.front().triangles().count() != trees.triangles()) {
        auto target = trees.tree_of(chosen(trees.standing(), {}, 0), quiet, {});
        if (!target) return target.error();
        made.whole_.target = std::move(*target);
    }
    return made;
}

}  // namespace tex::inline v1
