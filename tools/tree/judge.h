// SPDX-License-Identifier: Apache-2.0
// judge.h: decides which outputs of a texture are up to date.

#pragma once

#include <atomic>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "tree/placement.h"
#include "tree/recipe.h"
#include "tree/state.h"
#include "tree/work.h"

namespace tex::cli {

// An output that must be made, and why.
struct Stale {
    std::size_t index = 0;  // in the recipe
    Digest settings;
    std::string why;                   // "tiling: 8 to 6"
    std::vector<Change> changes = {};  // if they are known
    NamedValues named = {};            // the settings, for people
};

// The contents of all files that the outputs are made from.
struct Inputs {
    Digest digest;
    NamedDigests files;
};

struct Judgement {
    Inputs inputs;
    std::vector<Stale> stale;
    std::vector<FileWarning> warnings;  // that making the other outputs called for
};

using PlacedFiles = std::vector<std::pair<std::string, PlacedFile>>;  // names relative to the root

// Any thread may call any of these functions.
class Judge {
public:
    Judge(BuildState& state, Contents& contents, int output_version)
        : state_(state), contents_(contents), version_(output_version) {}

    // Errors: io, for an input that cannot be read.
    [[nodiscard]] Result<Judgement> judge(const BuildTask& task, const Recipe& recipe);
    // Records an output that is in its place. Files that it had before, such as levels that it has no more, become
    // outputs that no rule makes. `warnings` are those of making it.
    void record(const BuildTask& task, const Stale& made, const Inputs& inputs, const PlacedFiles& files,
                std::vector<FileWarning> warnings);
    // Records files of an output that is not complete: they are ours, and it is not up to date.
    void record_part(const BuildTask& task, const std::string& output, const PlacedFiles& files);
    [[nodiscard]] bool has_changed() const { return changed_; }
    // Keeps all other threads out while the outputs are read.
    [[nodiscard]] std::unique_lock<std::mutex> hold() { return std::unique_lock(mutex_); }

private:
    void remember(const PlacedFiles& files);
    [[nodiscard]] bool find_why(const BuildTask& task, const Recipe& recipe, const Inputs& inputs, Stale& stale,
                                std::vector<FileWarning>& warnings);

    std::mutex mutex_;  // guards state_.outputs
    BuildState& state_;
    Contents& contents_;
    const int version_;
    std::atomic<bool> changed_{false};
};

// The name under which the cache knows an output.
[[nodiscard]] Digest key_of(const Digest& settings, const Digest& inputs);

}  // namespace tex::cli
