// SPDX-License-Identifier: Apache-2.0

#include "tree/judge.h"

#include <algorithm>
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

void Judge::remember(const PlacedFiles& files) {
    for (const auto& [name, file] : files) {
        if (file.stamp) contents_.remember(name, *file.stamp, file.digest);
    }
}

void Judge::record(const BuildTask& task, const Stale& made, const Digest& inputs, const PlacedFiles& files) {
    remember(files);
    const std::lock_guard lock(mutex_);
    OutputRecord& record = state_.outputs[task.outputs[made.index]];
    const OutputRecord before = std::exchange(record, {task.input, made.settings, inputs, {}});
    for (const auto& [name, file] : files) record.files.emplace_back(name, file.digest);
    for (const auto& old : before.files) {
        const auto has_name = [&](const auto& file) { return file.first == old.first; };
        if (std::none_of(files.begin(), files.end(), has_name))
            state_.outputs[old.first] = {before.input, before.settings, before.inputs, {old}};
    }
    changed_ = true;
}

void Judge::record_part(const BuildTask& task, const std::string& output, const PlacedFiles& files) {
    remember(files);
    const std::lock_guard lock(mutex_);
    OutputRecord& record = state_.outputs[output];
    record.input = task.input;
    record.inputs = {};
    for (const auto& [name, file] : files) {
        const auto known = std::find_if(record.files.begin(), record.files.end(),
                                        [name = name](const auto& other) { return other.first == name; });
        if (known == record.files.end()) {
            record.files.emplace_back(name, file.digest);
        } else {
            known->second = file.digest;
        }
    }
    changed_ = true;
}

}  // namespace tex::cli
