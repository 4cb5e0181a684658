// SPDX-License-Identifier: Apache-2.0

#include "tree/judge.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "cli/text.h"
#include "files/path_names.h"

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
    const std::vector<std::string> parts = recipe.own_files(task.input, contents_.path(task.input));
    files.insert(files.end(), parts.begin(), parts.end());
    files.insert(files.end(), recipe.files().begin(), recipe.files().end());
    for (const std::string& file : files) {
        const Result<Digest> digest = contents_.digest(file);
        if (!digest) return digest.error();
        inputs.add(digest->bytes.data(), digest->bytes.size());
        judgement.inputs.files.emplace_back(file, *digest);
    }
    judgement.inputs.digest = inputs.finish();
    // The extension may decide which format an output has by default.
    const std::string extension = slashed(std::filesystem::path(task.input).extension());
    for (std::size_t k = 0; k < task.outputs.size(); ++k) {
        const Digest settings =
            digest_of(fmt::format("libtex {}\n{}\n{}", version_, extension, recipe.outputs()[k].settings));
        Stale stale{k, settings, {}};
        stale.named = recipe.outputs()[k].named;
        stale.named.emplace_back("output-version", fmt::format("{}", version_));
        stale.named.emplace_back("input", extension);
        std::vector<FileWarning> warnings;
        if (find_why(task, recipe, judgement.inputs, stale, warnings)) {
            judgement.stale.push_back(std::move(stale));
        } else {
            add_new(std::move(warnings), judgement.warnings);
        }
    }
    return judgement;
}

// Finds out why an output must be made. Returns false if it is up to date, and then what making it called for.
bool Judge::find_why(const BuildTask& task, const Recipe& recipe, const Inputs& inputs, Stale& stale,
                     std::vector<FileWarning>& warnings) {
    OutputRecord record;
    NamedValues before;
    {
        const std::lock_guard lock(mutex_);
        const auto found = state_.outputs.find(task.outputs[stale.index]);
        if (found == state_.outputs.end()) {
            stale.why = "is new";
            return true;
        }
        record = found->second;
        const auto named = state_.settings.find(record.settings);
        if (record.settings != stale.settings && named != state_.settings.end()) before = named->second;
    }
    if (record.settings != stale.settings) {
        const auto preset = [&](const std::string& name) { return recipe.preset_of(name); };
        if (!before.empty()) stale.changes = changed_settings(before, stale.named, preset);
        if (stale.changes.empty()) stale.why = "its settings have changed";
    }
    if (record.inputs != inputs.digest) {
        std::vector<Change> files;
        if (!record.from.empty()) files = changed_files(record.from, inputs.files);
        if (files.empty() && stale.why.empty()) stale.why = "what it is made from has changed";
        stale.changes.insert(stale.changes.end(), files.begin(), files.end());
    }
    if (!stale.changes.empty()) stale.why = words_of(stale.changes);
    std::vector<std::string> names;
    for (const auto& [name, digest] : record.files) names.push_back(name);
    // The state may come from anywhere: it does not say which files an output has.
    if (stale.why.empty() && !recipe.are_files_of(task.input, stale.index, names))
        stale.why = "its files are others now";
    for (auto file = record.files.begin(); file != record.files.end() && stale.why.empty(); ++file) {
        const Result<Digest> now = contents_.digest(file->first);
        if (!now) {
            stale.why = fmt::format("{} is missing", printable(file->first));
        } else if (*now != file->second) {
            stale.why = fmt::format("{} was changed by something else", printable(file->first));
        }
    }
    warnings = std::move(record.warnings);
    return !stale.why.empty();
}

void Judge::remember(const PlacedFiles& files) {
    for (const auto& [name, file] : files) {
        if (file.stamp) contents_.remember(name, *file.stamp, file.digest);
    }
}

void Judge::record(const BuildTask& task, const Stale& made, const Inputs& inputs, const PlacedFiles& files,
                   std::vector<FileWarning> warnings) {
    remember(files);
    const std::lock_guard lock(mutex_);
    OutputRecord& record = state_.outputs[task.outputs[made.index]];
    const OutputRecord before = std::exchange(record, {task.input, made.settings, inputs.digest, {}, inputs.files});
    record.warnings = std::move(warnings);
    state_.settings[made.settings] = made.named;
    for (const auto& [name, file] : files) record.files.emplace_back(name, file.digest);
    for (const auto& old : before.files) {
        const auto has_name = [&](const auto& file) { return file.first == old.first; };
        if (std::none_of(files.begin(), files.end(), has_name))
            state_.outputs[old.first] = {before.input, before.settings, before.inputs, {old}, before.from};
    }
    changed_ = true;
}

void Judge::record_part(const BuildTask& task, const std::string& output, const PlacedFiles& files) {
    remember(files);
    const std::lock_guard lock(mutex_);
    OutputRecord& record = state_.outputs[output];
    record.input = task.input;
    record.inputs = {};
    record.from = {};
    record.warnings = {};
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
