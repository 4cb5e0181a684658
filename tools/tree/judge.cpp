// SPDX-License-Identifier: Apache-2.0

#include "tree/judge.h"

#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "cli/text.h"

namespace tex::cli {

Digest key_of(const Digest& settings, const Digest& inputs) {
    return Sha256()
        .add(settings.bytes.data(), settings.bytes.size())
        .add(inputs.bytes.data(), inputs.bytes.size())
        .finish();
}

Result<Judgement> Judge::judge(const BuildTask& task, const Recipe& recipe) {
    Judgement judgement;
    Sha256 inputs;
    std::vector<std::string> files = {task.input};
    files.insert(files.end(), recipe.files().begin(), recipe.files().end());
    for (const std::string& file : files) {
        const Result<Digest> digest = contents_.digest(file);
        if (!digest) return digest.error();
        inputs.add(digest->bytes.data(), digest->bytes.size());
    }
    judgement.inputs = inputs.finish();
    // The extension may decide which format an output has by default.
    const std::string extension = std::filesystem::path(task.input).extension().string();
    for (std::size_t k = 0; k < task.outputs.size(); ++k) {
        const Digest settings =
            digest_of(fmt::format("libtex {}\n{}\n{}", version_, extension, recipe.outputs()[k].settings));
        std::string why = why_stale(task.outputs[k], settings, judgement.inputs);
        if (!why.empty()) judgement.stale.push_back({k, settings, std::move(why)});
    }
    return judgement;
}

std::string Judge::why_stale(const std::string& output, const Digest& settings, const Digest& inputs) {
    OutputRecord record;
    {
        const std::lock_guard lock(mutex_);
        const auto found = state_.outputs.find(output);
        if (found == state_.outputs.end()) return "is new";
        record = found->second;
    }
    if (record.settings != settings) return "its settings have changed";
    if (record.inputs != inputs) return "what it is made from has changed";
    for (const auto& [file, digest] : record.files) {
        const Result<Digest> now = contents_.digest(file);
        if (!now) return fmt::format("{} is missing", printable(file));
        if (*now != digest) return fmt::format("{} was changed by something else", printable(file));
    }
    return {};
}

Result<void> Judge::record(const BuildTask& task, const Stale& made, const Digest& inputs,
                           const std::vector<std::string>& files) {
    OutputRecord record{task.input, made.settings, inputs, {}};
    for (const std::string& file : files) {
        const Result<Digest> digest = contents_.digest_of_own(file);
        if (!digest) return digest.error();
        record.files.emplace_back(file, *digest);
    }
    const std::lock_guard lock(mutex_);
    state_.outputs[task.outputs[made.index]] = std::move(record);
    changed_ = true;
    return {};
}

void Judge::forget(const std::string& output) {
    const std::lock_guard lock(mutex_);
    changed_ = state_.outputs.erase(output) > 0 || changed_;
}

}  // namespace tex::cli
