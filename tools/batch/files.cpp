// SPDX-License-Identifier: Apache-2.0

#include "batch/files.h"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "batch/collisions.h"
#include "batch/name_pattern.h"
#include "cli/stream.h"
#include "cli/text.h"
#include "cli/usage_error.h"
#include "files/system_error.h"
#include "files/through_file.h"
#include "reports/text_file.h"

namespace tex::cli {
namespace {

namespace fs = std::filesystem;

bool is_block_encoding(Encoding encoding) { return format_info(encoding_info(encoding).format).has_blocks(); }

// The names in a list: one on each line or, where the list holds a NUL, up to each NUL.
std::vector<std::string> names_in(const std::string& text) {
    const char separator = text.find('\0') == std::string::npos ? '\n' : '\0';
    std::vector<std::string> names;
    for (std::string_view rest = text; !rest.empty();) {
        const std::size_t end = std::min(rest.find(separator), rest.size());
        if (end > 0) names.emplace_back(rest.substr(0, end));
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return names;
}

}  // namespace

bool is_folder(const std::string& path) {
    std::error_code error;
    return path.ends_with('/') || fs::is_directory(path, error);
}

void FileOptions::add(Command& command) {
    command.group("Files");
    command
        .text(output, "-o,--output", "FILE",
              joins ? "the output, of all inputs together; - is standard output"
                    : "the output of a single input; - is standard output")
        .completes = Completes::files;
    command.text(out_dir, "--out-dir", "DIR", "the folder for the outputs of many inputs, created if missing")
        .completes = Completes::directories;
    command.text(name, "--name", "PATTERN", "names of outputs, made of {dir} {stem} {ext} {level} {format}");
    add_list(command);
    command.text(depfile, "--depfile", "FILE", "write what each output was made from, for Make and Ninja").completes =
        Completes::files;
    command.flag(no_clobber, "--no-clobber", "never replace a file");
    command.flag(no_sync, "--no-sync", "do not wait until outputs are on the disk");

    command.check([this, &command] {
        if (named_descriptor(output) == STDOUT_FILENO) output = "-";  // /dev/stdout and its other names
        if (!output.empty() && !out_dir.empty()) throw UsageError("--output and --out-dir contradict each other");
        if (!output.empty() && !name.empty()) throw UsageError("--output and --name contradict each other");
        check_inputs(command);
        if (output.empty() && out_dir.empty() && name.empty())
            throw UsageError("no output: give -o FILE or --out-dir DIR");
        if (output == "-" && command.given("--json")) throw UsageError("-o - and --json both want standard output");
        if (output == "-" && stdout_is_terminal()) throw UsageError("-o -: standard output is a terminal");
        if (output == "-" && no_clobber) throw UsageError("-o - and --no-clobber contradict each other");
        if (output == "-" && !depfile.empty()) throw UsageError("--depfile has no name for standard output");
        if (depfile == "-") throw UsageError("--depfile: needs a file, not standard output");
        if (is_folder(output)) {
            throw UsageError(fmt::format("-o {}: is a folder; --out-dir writes into one", printable(output)));
        }
    });
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
}

void FileOptions::check_inputs(const Command& command) const {
    if (command.inputs().empty() && files_from.empty())
        throw UsageError("no input; " + command.name() + " --help tells more");
    const auto dashes = std::count(command.inputs().begin(), command.inputs().end(), "-") + (files_from == "-" ? 1 : 0);
    if (dashes > 1) throw UsageError("standard input can only be read once");
}

Result<std::vector<std::string>> FileOptions::list_inputs(const Command& command) const {
    std::vector<std::string> inputs = command.inputs();
    if (!files_from.empty()) {
        const auto list = read_text_file(files_from);
        if (!list) return list.error();
        const std::vector<std::string> listed = names_in(*list);
        inputs.insert(inputs.end(), listed.begin(), listed.end());
    }
    return inputs;
}

std::string FileOptions::batch_name(const std::string& input, const OutputOptions& options,
                                    const OutputDefaults& defaults) const {
    NameFields fields = name_fields(input);
    std::string pattern = name;
    if (pattern.empty()) {
        std::optional<Container> container = options.container;
        if (!container && options.format) {
            if (is_block_encoding(*options.format)) container = Container::dds;
        } else if (!container) {
            container = defaults.batch;
        }
        pattern = "{stem}" + (container ? extension_of(*container) : "{ext}");
    }
    if (options.format) {
        fields.format = name_of(kEncodingNames, *options.format);
    } else if (const NamePattern parsed(pattern); parsed.uses("format")) {
        const Container container = options.container_for(parsed.expand(fields), defaults.standard_output);
        fields.format = name_of(kEncodingNames, default_encoding(container));
    }
    return place(pattern, fields);
}

std::string FileOptions::place(const std::string& pattern, const NameFields& fields) const {
    const NamePattern parsed(pattern);
    std::string file = parsed.expand(fields);
    if (file == "-") throw UsageError("a name made of a pattern is -, which is standard output; -o - writes there");
    if (out_dir.empty()) return file;
    const fs::path dir = fs::path(fields.dir).lexically_normal();
    if (parsed.uses("dir") && (dir.is_absolute() || *dir.begin() == "..")) {
        throw UsageError(fmt::format("{}: its {{dir}} leads out of --out-dir",
                                     printable(fields.dir + "/" + fields.stem + fields.ext)));
    }
    return (fs::path(out_dir) / fs::path(file).relative_path()).string();
}

Result<std::vector<Task>> FileOptions::plan(const Command& command, const OutputOptions& output_options,
                                            const OutputDefaults& defaults) const {
    auto inputs = list_inputs(command);
    if (!inputs) return inputs.error();
    std::vector<std::string> also = shared;
    if (joins && !output.empty() && !inputs->empty()) {
        also.insert(also.begin(), inputs->begin() + 1, inputs->end());
        inputs->resize(1);
    }
    if (!output.empty() && inputs->size() > 1) {
        throw UsageError(fmt::format("-o takes one input, {} are given; --out-dir takes many", inputs->size()));
    }
    if (!output.empty() && inputs->empty())
        throw UsageError(fmt::format("no input for -o: {} names none", printable(files_from)));
    std::vector<Task> tasks;
    for (const std::string& input : *inputs) {
        Task task{input, output.empty() ? batch_name(input, output_options, defaults) : output, Container::dds, also};
        task.container = output_options.container_for(with_level(task.output, 0), defaults.standard_output);
        if (output_options.format)
            OutputOptions::check_holds(with_level(task.output, 0), task.container, *output_options.format);
        if (amend) amend(task);
        tasks.push_back(std::move(task));
    }
    check_collisions(tasks, depfile, files_from);
    return tasks;
}

Result<void> FileOptions::create_folders(const std::vector<Task>& tasks) const {
    if (out_dir.empty()) return {};
    const auto failed = [](const fs::path& path, const std::error_code& error) {
        return Error{ErrorCode::io, path.string(), "cannot create this folder: " + system_reason(error.value())};
    };
    std::error_code error;
    fs::create_directory(fs::path(out_dir) / "", error);
    if (error && !is_folder(out_dir)) return failed(out_dir, error);
    for (const Task& task : tasks) {
        std::vector<std::string> outputs = task.beside;
        outputs.push_back(task.output);
        for (const std::string& output_file : outputs) {
            const fs::path folder = fs::path(output_file).parent_path();
            fs::create_directories(folder, error);
            if (error) return failed(folder, error);
        }
    }
    return {};
}

}  // namespace tex::cli
