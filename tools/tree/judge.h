// SPDX-License-Identifier: Apache-2.0
// judge.h: decides which outputs of a texture are up to date.

#pragma once

#include <atomic>
#include <mutex>
#include <string>
#include <vector>

#include "tree/recipe.h"
#include "tree/state.h"
#include "tree/work.h"

namespace tex::cli {

// An output that must be made, and why.
struct Stale {
    std::size_t index = 0;  // in the recipe
    Digest settings;
    std::string why;  // "its settings have changed"
};

struct Judgement {
    Digest inputs;  // of the contents of all files that the outputs are made from
    std::vector<Stale> stale;
};

// Any thread may call any of these functions.
class Judge {
public:
    Judge(BuildState& state, Contents& contents, int output_version)
        : state_(state), contents_(contents), version_(output_version) {}

    // Errors: io, for an input that cannot be read.
    [[nodiscard]] Result<Judgement> judge(const BuildTask& task, const Recipe& recipe);
    // Records an output that was made. `files` are relative to the root.
    [[nodiscard]] Result<void> record(const BuildTask& task, const Stale& made, const Digest& inputs,
                                      const std::vector<std::string>& files);
    // Forgets an output, because it is about to be replaced.
    void forget(const std::string& output);
    [[nodiscard]] bool has_changed() const { return changed_; }
    // Keeps all other threads out while the outputs are read.
    [[nodiscard]] std::unique_lock<std::mutex> hold() { return std::unique_lock(mutex_); }

private:
    [[nodiscard]] std::string why_stale(const std::string& output, const Digest& settings, const Digest& inputs);

    std::mutex mutex_;  // guards state_.outputs
    BuildState& state_;
    Contents& contents_;
    const int version_;
    std::atomic<bool> changed_{false};
};

// The name under which the cache knows an output.
[[nodiscard]] Digest key_of(const Digest& settings, const Digest& inputs);

}  // namespace tex::cli
