// SPDX-License-Identifier: Apache-2.0

#include "batch/plan.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "cli/text.h"
#include "cli/text_file.h"
#include "cli/usage_error.h"
#include "tasks/collisions.h"
#include "tasks/depfile.h"
#include "tasks/folders.h"
#include "tasks/name_pattern.h"

namespace tex::cli {
namespace {

namespace fs = std::filesystem;

bool is_block_encoding(Encoding encoding) { return format_info(encoding_info(encoding).format).has_blocks(); }

// The name pattern for --out-dir if the user gives none.
std::string default_pattern(const Input& input, const FileOptions& files, const OutputOptions& output,
                            const OutputRules& rules) {
    std::optional<Container> container = output.made_container();
    if (!container && output.keeps_format) {
        container = container_of(input.name);
    } else if (!container && output.format) {
        if (is_block_encoding(*output.format))
            container = can_hold(Container::dds, *output.format) ? Container::dds : Container::ktx2;
    } else if (!container) {
        container = rules.batch;
    }
    std::string pattern = output.engines.size() > 1 ? "{engine}/" : "";
    if (!files.root.empty() || !input.folder.empty()) pattern += "{dir}/";
    const std::string suffix(output.engine != nullptr ? output.engine->suffix : "");
    if (input.model) {
        pattern += "{stem}_{material}" + suffix;
    } else {
        pattern += suffix.empty() ? "{stem}" : fmt::format("{{stem:-{}}}{}", suffix, suffix);
    }
    return pattern + (container ? extension_of(*container) : "{ext}");
}

std::string output_name(const Input& input, const FileOptions& files, const OutputOptions& output,
                        const OutputRules& rules) {
    if (files.in_place) {
        if (input.model || input.name == "-" || is_special_file(input.name))
            throw UsageError("--in-place",
                             printable(input.name) + (input.model ? " is a model, and -o names what it becomes"
                                                                  : " is no file that can be replaced"));
        return input.name;
    }
    NameFields fields = files.fields_of(input);
    if (input.model) {
        fields.material = input.model->map ? input.model->field : "0";  // without a map, nothing is written
        fields.ext = extension_of(Container::png);                      // the input's own is that of the model
    }
    const std::string pattern = files.name.empty() ? default_pattern(input, files, output, rules) : files.name;
    // The output would have the extension of the input, which has none.
    std::error_code no_status;
    if (pattern.ends_with("{ext}") && fields.ext.empty() && fs::is_directory(input.name, no_status))
        throw UsageError(printable(input.name), "is a directory; name its files");
    output.fill(fields);
    if (const NamePattern parsed(pattern); !output.format && parsed.uses("format")) {
        output.check_knows_format();
        const Container container = output.container_for(parsed.expand(fields), rules.standard_output);
        fields.format = name_of(kEncodingNames, rules.encoding(container));
    }
    return with_tile(files.place(pattern, fields), rules.tiles ? input.tile : 0);
}

// The name that -o gives for this input. Of the fields of --name it knows {level}.
std::string output_of(const std::string& pattern, const Input& input) {
    return marked_name(input.place ? with_grid(pattern, *input.place) : with_tile(pattern, input.tile));
}

// Engines decode 2c - 1, in whatever file, and our files of floats hold x, y and z themselves.
void check_fits_engine(const std::string& output, Encoding encoding, const Engine& engine) {
    if (format_info(encoding_info(encoding).format).sample != SampleKind::floating) return;
    throw UsageError(fmt::format(
        "{}: {} holds x, y and z themselves, and {} decodes 2c - 1: --format rgb16 in a .png file has 16 bits",
        printable(output), name_of(kEncodingNames, encoding), engine.name));
}

// The number of inputs is too large for -o.
[[noreturn]] void refuse_many(const std::vector<Input>& inputs, const OutputRules& rules) {
    const bool all_one = std::all_of(inputs.begin(), inputs.end(), [&](const Input& input) {
        return input.model && input.name == inputs.front().name;
    });
    if (!all_one)
        throw UsageError(fmt::format("-o takes one input, {} are given; --out-dir takes many", inputs.size()));
    throw UsageError(fmt::format("-o takes one map, and {} has {}; --material chooses one, --out-dir takes all{}",
                                 printable(inputs.front().name), inputs.size(),
                                 rules.writes_models ? ", and a name such as x.glb the model itself" : ""));
}

void set_model(Task& task, const Input& input) {
    task.model = input.model;
    if (!input.model) return;
    for (const std::string& file : input.model->beside) task.own.push_back(file);
}

void join(Task& task, const Input& input) {
    task.joined.push_back(input.name);
    task.joined_models.push_back(input.model);
    if (!input.model) return;
    for (const std::string& file : input.model->beside) {
        if (std::find(task.own.begin(), task.own.end(), file) == task.own.end()) task.own.push_back(file);
    }
}

// Throws UsageError if -o names tiles that an input does not have.
void check_tiles(const std::vector<Input>& inputs, const FileOptions& files) {
    if (!has_tile(files.output)) return;
    for (const Input& input : inputs) {
        if (input.tile == 0)
            throw UsageError(fmt::format("-o {} needs <UDIM> in the input, {} has none", printable(files.output),
                                         printable(input.name)));
    }
}

// Meshes with an input for each of their tiles, if outputs are made for tiles.
std::vector<Input> with_tiles(std::vector<Input> inputs, const FileOptions& files, const OutputRules& rules) {
    if (!has_tile(files.output) && !has_tile(files.name)) return inputs;
    std::vector<Input> all;
    for (Input& input : inputs) {
        const std::vector<int> tiles = input.tile == 0 ? rules.tiles(input.name) : std::vector<int>();
        for (const int tile : tiles) {
            all.push_back(input);
            all.back().tile = tile;
        }
        if (tiles.empty()) all.push_back(std::move(input));
    }
    return all;
}

// An input for each material.
std::vector<Input> with_materials(const std::vector<Input>& inputs, const OutputRules& rules) {
    std::vector<Input> all;
    for (const Input& input : inputs) {
        for (Input& material : rules.materials(input)) all.push_back(std::move(material));
    }
    return all;
}

// Throws UsageError if the outputs for several engines cannot be made in one run.
void check_engines(const std::vector<Task>& tasks, std::size_t engines) {
    if (engines < 2) return;
    for (const Task& task : tasks) {
        std::vector<std::string> read = task.prerequisites();
        read.push_back(task.input);
        if (std::find(read.begin(), read.end(), "-") != read.end())
            throw UsageError("standard input can only be read once, so --for takes one engine");
    }
}

}  // namespace

Task complete(Task task, const OutputOptions& output, const OutputRules& rules) {
    const std::string first = with_level(task.output, 0);
    task.engine = output.engine;
    task.shared = rules.shared;
    task.container = output.container_for(first, rules.standard_output);
    if (output.format) OutputOptions::check_holds(first, task.container, *output.format);
    if (output.format && task.engine != nullptr) check_fits_engine(first, *output.format, *task.engine);
    if (rules.amend) rules.amend(task);
    return task;
}

std::vector<Task> plan_outputs(std::vector<Input> inputs, const FileOptions& files, const OutputOptions& output,
                               const OutputRules& rules) {
    if (const std::size_t engines = output.engines.size(); engines > 1 && !files.output.empty())
        throw UsageError(fmt::format("-o takes one engine of --for, {} are given; --out-dir takes many", engines));
    std::vector<Input> joined;
    if (rules.joins && (!files.output.empty() || rules.materials) && !inputs.empty()) {
        joined.assign(inputs.begin() + 1, inputs.end());
        inputs.resize(1);
    }
    if (rules.materials) {
        inputs = with_materials(inputs, rules);
    } else if (rules.tiles) {
        inputs = with_tiles(std::move(inputs), files, rules);
    } else {
        check_tiles(inputs, files);
    }
    const bool names_each = has_tile(files.output) || (files.tiles && has_grid(files.output));
    if (!files.output.empty() && inputs.size() > 1 && !names_each) refuse_many(inputs, rules);
    if (!files.output.empty() && inputs.empty())
        throw UsageError(fmt::format("no input for -o: {} names none", printable(files.files_from)));
    std::vector<Task> tasks;
    for (const Input& input : inputs) {
        for (const Engine* const engine : output.engines_or_none()) {
            const OutputOptions own = output.of(engine);
            const std::string name =
                files.output.empty() ? output_name(input, files, own, rules) : output_of(files.output, input);
            Task planned{input.name, name};
            planned.tile = input.tile;
            planned.in_folder = !input.folder.empty();
            planned.pattern = input.pattern;
            planned.model = input.model;
            Task task = complete(std::move(planned), own, rules);
            set_model(task, input);
            for (const Input& other : joined) join(task, other);
            task.place = input.place;
            tasks.push_back(std::move(task));
        }
    }
    check_engines(tasks, output.engines.size());
    if (rules.relate) rules.relate(tasks);
    if (!files.depfile.empty()) check_depfile_names(tasks);
    check_collisions(tasks, files.depfile, files.lists(), rules.in_place && (files.in_place || !files.output.empty()));
    return tasks;
}

Result<void> create_folders(const FileOptions& files, const std::vector<Task>& tasks) {
    if (files.out_dir.empty() && !files.names_folders()) return {};
    std::error_code error;
    if (!files.out_dir.empty()) fs::create_directory(fs::path(files.out_dir) / "", error);
    if (error && !is_folder(files.out_dir)) return no_folder_error(files.out_dir, error);
    for (const Task& task : tasks) {
        for (const std::string& output : task.outputs()) {
            if (auto created = create_folders_of(output); !created) return created;
        }
    }
    return {};
}

}  // namespace tex::cli
