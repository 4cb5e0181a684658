// SPDX-License-Identifier: Apache-2.0
// shared_trees.h: trees over parts of a high mesh, for one call of transfer() or several: see share_trees().

#pragma once

#include <atomic>
#include <cstddef>
#include <list>
#include <memory>
#include <utility>
#include <vector>

#include <tex/transfer.h>

#include "mesh/node_transform.h"
#include "rays/box_tree.h"
#include "rays/part_trees.h"

namespace tex::inline v1 {

// Parts that rays meet together.
struct RayTarget {
    Triangles triangles;
    BoxTree tree;
};

class SharedTrees {
public:
    // `trees` for as long as the result is held, or others if it is null or somebody else holds it.
    static std::shared_ptr<SharedTrees> take(const std::shared_ptr<SharedTrees>& trees);

    // Forgets all that is not of this high mesh. Errors: bad_data (a place is not invertible), out_of_memory.
    Result<void> set(const std::vector<MeshPart>& high, const std::vector<PartPlace>& places);

    // How many triangles stand in all places.
    [[nodiscard]] std::size_t triangles() const { return count_; }
    // How many places there are, or else parts.
    [[nodiscard]] std::size_t standing() const { return places_.empty() ? parts_.size() : places_.size(); }

    // The tree over those with these numbers, which must have a triangle. It refers to this. Errors: bad_data
    // (coordinates become infinite), out_of_memory, cancelled.
    Result<std::shared_ptr<const RayTarget>> tree_of(const std::vector<std::size_t>& numbers,
                                                     const Execution& execution, ProgressSpan span);

private:
    struct Kept {
        std::vector<std::size_t> numbers;
        std::shared_ptr<const RayTarget> target;
    };
    // What a part consists of, to know it again.
    struct KnownPart {
        const MeshPart* part;
        const void *positions, *indices;
        std::size_t vertices, corners;
        friend bool operator==(const KnownPart&, const KnownPart&) = default;
    };

    static std::vector<KnownPart> known_parts(const std::vector<MeshPart>& high);
    void forget();
    [[nodiscard]] bool is_of(const std::vector<KnownPart>& parts, const std::vector<PartPlace>& places) const;
    [[nodiscard]] Triangles triangles_of(const std::vector<std::size_t>& numbers) const;

    std::atomic<bool> is_taken_{false};
    std::vector<KnownPart> parts_;
    std::vector<PartPlace> given_;
    std::vector<NodeTransform> placements_;
    std::vector<StandingPart> places_;  // if parts have any, which refer to `placements_`
    std::size_t count_ = 0;
    PartTrees trees_;  // of parts that stand in several places
    std::list<Kept> kept_;
};

}  // namespace tex::inline v1
