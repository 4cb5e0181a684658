// SPDX-License-Identifier: Apache-2.0

#include "rays/ray_groups.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "rows/usable.h"

namespace tex::inline v1 {
namespace {

// The parts with a number, or all of them.
std::vector<const MeshPart*> parts_of(const std::vector<MeshPart>& high, const std::vector<int>& numbers, int number) {
    std::vector<const MeshPart*> parts;
    for (std::size_t k = 0; k < high.size(); ++k) {
        if (numbers.empty() || numbers[k] == number) parts.push_back(&high[k]);
    }
    return parts;
}

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

Result<RayGroups> RayGroups::make(const MeshPart& low, const std::vector<MeshPart>& high, const TransferInputs& inputs,
                                  bool whole, const Execution& execution, ProgressSpan span) {
    std::size_t count = 0;
    for (const MeshPart& part : high) count += part.triangles();
    if (count == 0) return Error{ErrorCode::bad_option, {}, "the high mesh is empty"};
    if (count > kMaxTriangles) return Error{ErrorCode::unsupported, {}, "the high mesh has more than 2^28 triangles"};
    const std::vector<int> numbers = common_numbers(inputs);
    if (numbers.empty()) return bad_option("no part of the high mesh belongs to one of the low mesh");
    RayGroups made;
    const Execution quiet = execution.quiet();
    for (const int number : numbers) {
        Triangles triangles(parts_of(high, inputs.high_groups, number));
        auto tree = numbers.size() == 1 ? BoxTree::build(triangles, execution, span) : BoxTree::build(triangles, quiet);
        if (!tree) return tree.error();
        made.groups_.push_back(RayGroup{number, std::move(triangles), std::move(*tree)});
    }
    for (std::size_t t = 0; t < low.triangles() && !inputs.low_groups.empty(); ++t) {
        const auto found = std::lower_bound(numbers.begin(), numbers.end(), inputs.low_groups[t]);
        const bool has_group = found != numbers.end() && *found == inputs.low_groups[t];
        made.of_low_.push_back(has_group ? static_cast<int>(found - numbers.begin()) : kNone);
    }
    if (whole && made.groups_.front().triangles.count() != count) {
        auto tree = BoxTree::build(Triangles(parts_of(high, {}, 0)), quiet);
        if (!tree) return tree.error();
        made.whole_ = std::move(*tree);
    }
    return made;
}

}  // namespace tex::inline v1
