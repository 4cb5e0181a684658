// SPDX-License-Identifier: Apache-2.0
// work.h: the textures of a tree: which input becomes which outputs, by which recipe.

#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "tasks/find_files.h"
#include "tree/recipe.h"

namespace tex::cli {

// The outputs of one input. Paths are relative to the root.
struct BuildTask {
    std::string input;
    std::int64_t size = 0;  // of the input in bytes
    std::size_t recipe = 0;
    std::vector<std::string> outputs;  // one for each output of the recipe
    std::vector<std::size_t> needs;    // the tasks that make files which this one reads
    std::string refusal;               // why it cannot be made; empty if it can
};

struct WorkList {
    std::vector<BuildTask> tasks;         // sorted by input
    std::vector<std::string> unreadable;  // folders, each with the reason
    // Pictures that are named like normal maps, or like heights without normals, and that no rule is for, sorted.
    std::vector<std::string> without_rule;
    std::vector<std::string> other_pictures;  // with other names, beside inputs, that no rule is for, sorted
};

// Lists what the recipes make. Of several recipes that match a file, the first one makes it. Files in out-dir are no
// inputs, unless a pattern begins with its name. Two inputs of one recipe whose outputs are one file, or have names
// that differ only in the case of letters, are refused, and the others are made.
//
// Pictures that a rule excludes, makes or reads need no rule. Only folders that a pattern reaches are looked at.
//
// Calls `entered`, unless it is empty, with each folder before it is read.
//
// Throws UsageError: two recipes with one output; recipes that need each other's outputs.
[[nodiscard]] WorkList list_work(const std::vector<Recipe>& recipes, const std::string& root,
                                 const FolderVisitor& entered = {});

// The tasks `part`, those that need them, and those that they need.
[[nodiscard]] WorkList part_of(const WorkList& work, std::set<std::size_t> part);

}  // namespace tex::cli
