// SPDX-License-Identifier: Apache-2.0
// part_trees.h: a tree for each part that stands in several places, made once.

#pragma once

#include <map>
#include <memory>
#include <vector>

#include <tex/mesh.h>

#include "rays/box_tree.h"

namespace tex::inline v1 {

struct PartTree {
    BoxTree tree;
    std::vector<Float3> corners;  // the vertices that triangles use
};

class PartTrees {
public:
    // Errors: out_of_memory, cancelled.
    Result<std::shared_ptr<const PartTree>> tree_of(const MeshPart& part, const Execution& execution);

private:
    std::map<const MeshPart*, std::shared_ptr<const PartTree>> trees_;
};

}  // namespace tex::inline v1
