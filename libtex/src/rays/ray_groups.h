// SPDX-License-Identifier: Apache-2.0
// ray_groups.h: which parts of the high mesh the rays of each triangle of the low one meet: TransferInputs::low_groups.

#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <tex/transfer.h>

#include "rays/shared_trees.h"

namespace tex::inline v1 {

// Parts of the high mesh that belong together.
struct RayGroup {
    int number;
    std::shared_ptr<const RayTarget> target;

    [[nodiscard]] const Triangles& triangles() const { return target->triangles; }
    [[nodiscard]] const BoxTree& tree() const { return target->tree; }
};

class RayGroups {
public:
    static constexpr int kNone = -1;

    // One group of all parts if `inputs` has no groups. With `whole`, there is a tree of all parts, too. `low` and
    // `high` must outlive this. Errors: bad_option (there are no triangles), unsupported (too many of them), bad_data
    // (a place is not invertible, or makes infinite coordinates), out_of_memory, cancelled.
    static Result<RayGroups> make(const MeshPart& low, const std::vector<MeshPart>& high, const TransferInputs& inputs,
                                  bool whole, const Execution& execution, ProgressSpan span);

    [[nodiscard]] const std::vector<RayGroup>& all() const { return groups_; }
    // The group whose parts the rays of a triangle meet, or kNone.
    [[nodiscard]] int of_low(std::size_t triangle) const { return of_low_.empty() ? 0 : of_low_[triangle]; }
    // Whether every triangle is of group 0.
    [[nodiscard]] bool has_all() const { return of_low_.empty(); }
    // Precondition: make() was asked for it, or there is one group.
    [[nodiscard]] const RayGroup& whole() const { return whole_.target ? whole_ : groups_.front(); }

private:
    std::shared_ptr<SharedTrees> trees_;  // to which the groups refer
    std::vector<RayGroup> groups_;
    std::vector<int> of_low_;  // empty: all are of group 0
    RayGroup whole_{kNone, nullptr};
};

}  // namespace tex::inline v1
