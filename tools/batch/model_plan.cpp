// SPDX-License-Identifier: Apache-2.0

#include "batch/model_plan.h"

#include <map>
#include <memory>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "cli/text.h"
#include "cli/usage_error.h"
#include "cli/value.h"
#include "tasks/collisions.h"
#include "tasks/depfile.h"
#include "tasks/model_output.h"
#include "tasks/name_pattern.h"

namespace tex::cli {
namespace {

// The options for the pictures in models. Throws UsageError.
OutputOptions picture_options(const FileOptions& files, const OutputOptions& output, const OutputRules& rules,
                              const Command& command) {
    if (output.engines.size() > 1) throw UsageError("--for", "a model is for one engine");
    OutputOptions own = output.of(output.engines_or_none().front());
    const std::string& name = files.output.empty() ? files.name : files.output;
    const auto refuse = [&](std::string_view what) { throw UsageError(fmt::format("{}: {}", printable(name), what)); };
    const bool is_basis = own.format == Encoding::uastc;
    const Container container = own.made_container().value_or(is_basis ? Container::ktx2 : Container::png);
    if (container != Container::png && container != Container::jpeg && container != Container::webp &&
        container != Container::ktx2) {
        refuse(fmt::format("the pictures of a model are PNG, JPEG, WebP or KTX2, not {}",
                           name_of(kContainerNames, container)));
    }
    if (container == Container::ktx2 && !is_basis) refuse("the KTX2 pictures of a model are of --format uastc");
    own.container = container;
    std::ignore = own.container_for("picture" + extension_of(container), container);
    if (own.format && !is_for_models(*own.format)) {
        refuse(fmt::format("models hold normals as {}, not as {}",
                           join(names_of(words_of(kEncodingNames, is_for_models))),
                           name_of(kEncodingNames, *own.format)));
    }
    if (own.format) OutputOptions::check_holds(name, container, *own.format);
    std::vector<std::string> names = {"--blue", "--alpha", "--length", "--layout", "--dds-header", "--dds-mark"};
    names.insert(names.end(), rules.not_for_models.begin(), rules.not_for_models.end());
    const auto idle = command.given_of(names);
    if (!idle.empty()) refuse(idle.front() + " is for one map, and not for models");
    return own;
}

std::string output_for(const Input& input, const FileOptions& files) {
    return files.output.empty() ? files.place(files.name, files.fields_of(input)) : files.output;
}

// Completes a task, and returns the files beside its model.
std::vector<ModelFile> fill(Task& task, const OutputOptions& own, const OutputRules& rules,
                            const MeshReadOptions& options) {
    task.container = *own.container;
    task.engine = own.engine;
    task.shared = rules.shared;
    if (rules.amend) rules.amend(task);
    if (rules.lods) return set_lod_output(task, *rules.models, rules.lods->tangents, rules.lods->occlusion, options);
    if (const auto& with = rules.conversion)
        return set_converted_output(task, *rules.models, with->tangents, with->changes_maps, options);
    return set_model_output(task, *rules.models, rules.keeps_maps, options);
}

// Files beside models that several of them have: the first task states them.
void leave_out_shared(std::vector<Task>& tasks, const std::vector<std::vector<ModelFile>>& files) {
    std::map<std::string, std::pair<std::string, bool>> known;
    for (std::size_t k = 0; k < tasks.size(); ++k) {
        for (const ModelFile& file : files[k]) {
            const auto [found, is_new] = known.emplace(file.path, std::pair(file.from, file.is_changed));
            if (!is_new && found->second == std::pair(file.from, file.is_changed))
                std::erase(tasks[k].more_outputs, file.path);
        }
    }
}

}  // namespace

Task complete_model(Task task, const FileOptions& files, const OutputOptions& output, const OutputRules& rules,
                    const Command& command, const MeshReadOptions& options) {
    const OutputOptions own = picture_options(files, output, rules, command);
    if (!lower_case(task.output).ends_with(".glb"))
        throw UsageError(fmt::format("{}: a rule writes models as .glb", printable(task.output)));
    fill(task, own, rules, options);
    if (task.more_outputs.empty()) return task;
    auto refused = std::make_shared<ModelOutput>();
    refused->error = Error{ErrorCode::unsupported, task.input,
                           fmt::format("names {} files, and a rule writes models in one file each: put them into it",
                                       task.more_outputs.size())};
    task.model_output = refused;
    task.more_outputs.clear();
    return task;
}

bool writes_models(const FileOptions& files) { return names_model(files.output) || names_model(files.name); }

std::vector<Task> plan_models(std::vector<Input> inputs, const FileOptions& files, const OutputOptions& output,
                              const OutputRules& rules, const Command& command, const MeshReadOptions& options) {
    const OutputOptions own = picture_options(files, output, rules, command);
    std::vector<std::string> joined;
    if (rules.joins && !files.output.empty() && !inputs.empty()) {
        for (std::size_t k = 1; k < inputs.size(); ++k) joined.push_back(inputs[k].name);
        inputs.resize(1);
    }
    if (!files.output.empty() && inputs.size() > 1)
        throw UsageError(fmt::format("-o takes one input, {} are given; --out-dir takes many", inputs.size()));
    std::vector<Task> tasks;
    std::vector<std::vector<ModelFile>> all_files;
    for (const Input& input : inputs) {
        Task task{input.name, output_for(input, files), *own.container};
        task.joined = joined;
        task.joined_models.resize(joined.size());
        all_files.push_back(fill(task, own, rules, options));
        tasks.push_back(std::move(task));
    }
    leave_out_shared(tasks, all_files);
    if (!files.depfile.empty()) check_depfile_names(tasks);
    check_collisions(tasks, files.depfile, files.lists());
    return tasks;
}

}  // namespace tex::cli
