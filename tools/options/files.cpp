// SPDX-License-Identifier: Apache-2.0

#include "options/files.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "cli/file_status.h"
#include "cli/text.h"
#include "cli/text_file.h"
#include "cli/usage_error.h"
#include "files/path_names.h"
#include "files/system_error.h"
#include "files/through_file.h"
#include "tasks/engines.h"
#include "tasks/find_files.h"
#include "tasks/folders.h"

namespace tex::cli {
namespace {

namespace fs = std::filesystem;

}  // namespace

void FileOptions::add(Command& command, bool joins) {
    command.group("Files");
    Option& row = command.output_file(output, "-o,--output",
                                      joins ? "the output, of all inputs together; - is standard output"
                                            : "the output of a single input; - is standard output");
    row.often(1, joins ? "the output, of all inputs together" : "the output of a single input");
    row.take = [take = row.take](const std::string& text) {  // /dev/stdout and its other names
        take(named_descriptor(text) == kStandardOutput ? "-" : text);
    };
    command.text(out_dir, "--out-dir", "DIR", "the folder for the outputs of many inputs, created if missing")
        .often(2, "the folder for the outputs of many inputs")
        .completes = Completes::directories;
    command.text(
        name, "--name", "PATTERN",
        "names of outputs, made of {dir} {stem} {stem:-SUFFIX} {ext} {level} {format} {engine} {type} {material}");
    command
        .text(root, "--root", "DIR",
              "{dir} is relative to this folder, which holds the inputs; the default of --name begins with {dir}/")
        .completes = Completes::directories;
    add_list(command);
    command.flag(update, "--update", "skip inputs whose outputs are newer than everything that they are made from");
    command.output_file(depfile, "--depfile", "write what each output was made from, for Make and Ninja");
    command.flag(no_clobber, "--no-clobber", "never replace a file");
    command.flag(no_sync, "--no-sync", "do not wait until outputs are on the disk");
    command.check([this, &command] { check(command); });
}

void FileOptions::check(const Command& command) {
    if (!output.empty() && !out_dir.empty()) throw UsageError("--output and --out-dir contradict each other");
    if (!output.empty() && !name.empty()) throw UsageError("--output and --name contradict each other");
    if (!output.empty() && !root.empty()) throw UsageError("--output and --root contradict each other");
    if (!root.empty() && !name.empty() && !NamePattern(name).uses("dir"))
        throw UsageError("--root has no effect, because --name does not contain {dir}");
    check_inputs(command);
    const std::vector<std::string> of_outputs = {"--output", "--out-dir",    "--name",   "--root",
                                                 "--update", "--no-clobber", "--depfile"};
    if (const auto given = command.given_of(of_outputs); in_place && !given.empty())
        throw UsageError("--in-place and " + given.front() + " contradict each other");
    if (writes() && output.empty() && out_dir.empty() && name.empty() && !in_place)
        throw UsageError("no output: give -o FILE or --out-dir DIR");
    if (depfile == "-") throw UsageError("--depfile", "needs a file, not standard output");
    if (is_folder(output)) {
        throw UsageError(fmt::format("-o {}: is a folder; --out-dir writes into one", printable(output)));
    }
    if (output != "-") return;
    if (command.given("--json")) throw UsageError("-o - and --json both want standard output");
    if (update) throw UsageError("-o - and --update contradict each other");
    if (no_clobber) throw UsageError("-o - and --no-clobber contradict each other");
    if (!depfile.empty()) throw UsageError("--depfile has no name for standard output");
}

void FileOptions::add_inputs(Command& command, std::function<bool()> needless) {
    command.group("Files");
    add_list(command);
    command.check([this, &command, needless = std::move(needless)] {
        if (!needless || !needless()) check_inputs(command);
    });
}

void FileOptions::add_list(Command& command) {
    command
        .text(files_from, "--files-from", "LIST",
              "read names of inputs from a file, one a line or separated by NUL; - is standard input")
        .completes = Completes::files;
    command.flag(allow_empty, "--allow-empty", "accept a list of --files-from that names no input");
}

void FileOptions::check_inputs(const Command& command) {
    argument_files_ = command.argument_files();
    if (command.inputs().empty() && files_from.empty()) throw UsageError("no input; see " + command.name() + " --help");
    const auto dashes = std::count(command.inputs().begin(), command.inputs().end(), "-") +
                        (files_from == "-" ? 1 : 0) + (command.has_read_standard_input() ? 1 : 0);
    if (dashes > 1) throw UsageError("standard input can only be read once");
}

std::vector<NamedFile> FileOptions::lists() const {
    std::vector<NamedFile> lists = {{"--files-from", files_from}};
    for (const std::string& file : argument_files_) lists.push_back({"@" + file, file});
    return lists;
}

Result<std::vector<Input>> FileOptions::list_inputs(const Command& command) const {
    std::vector<Input> inputs;
    for (const std::string& input : command.inputs()) {
        if (tiles) {
            if (!has_grid(input))
                throw UsageError(fmt::format(
                    "--tiles needs {{x}} and {{y}} in the name of the input, {} lacks one of them", printable(input)));
            auto found = grid_files(input);
            if (!found) return found.error();
            for (GridFile& file : *found) inputs.push_back({std::move(file.name), 0, input, std::move(file.place)});
            continue;
        }
        if (is_pattern(input)) {  // the shell left it as it is
            auto files = files_matching(input);
            if (!files) return files.error();
            for (std::string& file : *files) inputs.push_back({std::move(file)});
            continue;
        }
        if (input.ends_with('/') && !status_of(input)) return Error{ErrorCode::io, input, "no such file or directory"};
        if (reads_folders && is_folder(input)) {
            if (auto listed = list_folder(input, inputs); !listed) return listed.error();
            continue;
        }
        if (command.inputs().size() == 1 && is_folder(input)) {
            return Error{
                ErrorCode::io, input,
                fmt::format("is a directory; name its files, such as '{}*.png'", slashed(fs::path(input) / ""))};
        }
        auto files = inputs_of(input);
        if (!files) return files.error();
        std::move(files->begin(), files->end(), std::back_inserter(inputs));
    }
    if (tiles && !files_from.empty()) throw UsageError("--tiles and --files-from contradict each other");
    if (!files_from.empty()) {
        const auto list = read_text_file(files_from);
        if (!list) return list.error();
        for (std::string& input : list_of(*list)) inputs.push_back({std::move(input)});
        if (inputs.empty() && !allow_empty) {
            throw UsageError("--files-from",
                             fmt::format("{} names no input; --allow-empty accepts that", printable(files_from)));
        }
    }
    return inputs;
}

Result<void> FileOptions::list_folder(const std::string& folder, std::vector<Input>& inputs) const {
    auto found = pictures_below(folder);
    if (!found) return found.error();
    other_files_ += found->others;
    // What an earlier run wrote is no input of the next.
    if (!out_dir.empty() && !path_below(out_dir, folder))
        std::erase_if(found->files, [&](const std::string& file) { return path_below(out_dir, file).has_value(); });
    const std::set<std::string> made = made_in ? made_in(folder) : std::set<std::string>();
    const auto is_made = [&](const std::string& file) {
        return made.count(slashed(fs::path(file).lexically_normal())) > 0;
    };
    if (!std::all_of(found->files.begin(), found->files.end(), is_made))
        made_files_ += static_cast<std::int64_t>(std::erase_if(found->files, is_made));
    // Through a link, a file elsewhere would be replaced, which nobody has named.
    const auto is_linked = [&](const std::string& file) {
        std::error_code error;
        const fs::path real = fs::canonical(file, error), top = fs::canonical(folder, error);
        return error || real != (top / fs::path(file).lexically_relative(folder)).lexically_normal();
    };
    if (in_place) linked_files_ += static_cast<std::int64_t>(std::erase_if(found->files, is_linked));
    for (std::string& file : found->files) {
        inputs.push_back({std::move(file)});
        inputs.back().folder = folder;
    }
    return {};
}

std::string FileOptions::left_out() const {
    std::string text;
    const auto add = [&](std::int64_t files, std::string_view what) {
        if (files > 0) text += fmt::format("; {} {} left out, which {}", files, files == 1 ? "file" : "files", what);
    };
    add(other_files_, other_files_ == 1 ? "is no picture" : "are no pictures");
    add(made_files_, "build-normals made");
    add(linked_files_, "a link leads to");
    return text;
}

NameFields FileOptions::fields_of(const Input& input) const {
    NameFields fields = name_fields(input.name);
    const std::string& above = root.empty() ? input.folder : root;
    if (above.empty() || input.name == "-") return fields;
    const auto dir = path_below(above, fields.dir);
    if (!dir) throw UsageError(fmt::format("{} is not in --root {}", printable(input.name), printable(above)));
    fields.dir = *dir;
    return fields;
}

std::string FileOptions::place(const std::string& pattern, const NameFields& fields) const {
    const NamePattern parsed(pattern);
    std::string file = parsed.expand(fields);
    if (file == "-") throw UsageError("a name made of a pattern is -, which is standard output; -o - writes there");
    if (parsed.uses("dir") && file.starts_with("./")) file.erase(0, 2);
    if (const std::size_t here = file.find("/./"); parsed.uses("engine") && here != std::string::npos)
        file.erase(here, 2);
    if (out_dir.empty()) return file;
    const fs::path dir = fs::path(fields.dir).lexically_normal();
    if (parsed.uses("dir") && (dir.has_root_path() || *dir.begin() == "..")) {
        throw UsageError(printable(fields.dir + "/" + fields.stem + fields.ext), "its {dir} leads out of --out-dir");
    }
    return slashed(fs::path(out_dir) / fs::path(file).relative_path());
}

std::string FileOptions::further(const std::string& option, const std::string& pattern, const Task& task,
                                 std::string_view format) const {
    NameFields fields = name_fields(task.further ? task.further->input : task.input);
    fields.format = format;
    if (task.engine != nullptr) fields.engine = task.engine->name;
    if (task.model) fields.material = task.model->field;
    return task.further ? task.further->path_for(option, NamePattern(pattern).expand(fields)) : place(pattern, fields);
}

}  // namespace tex::cli
