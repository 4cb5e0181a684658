// SPDX-License-Identifier: Apache-2.0
// files.h: the option group of inputs and outputs, and the plan made of it: which file becomes which.

#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <tex/container.h>

#include "batch/name_pattern.h"
#include "cli/command.h"
#include "options/output.h"

namespace tex::cli {

// One input and where its result goes. `output` holds kLevelMark where each level has a file of its own.
struct Task {
    std::string input;
    std::string output;
    Container container = Container::dds;
    std::vector<std::string> also = {};    // further inputs of the same output
    std::vector<std::string> beside = {};  // further outputs, as `output`
};

// Whether `path` can only be a folder: it is one, or ends in a slash.
[[nodiscard]] bool is_folder(const std::string& path);

// Where outputs go whose name the user left to the command.
struct OutputDefaults {
    std::optional<Container> batch;  // with --out-dir: "{stem}" and its extension; none: the input's extension
    Container standard_output = Container::dds;  // of "-o -"
};

struct FileOptions {
    std::string output;
    std::string out_dir;
    std::string name;
    std::string files_from;
    std::string depfile;
    bool no_clobber = false;
    bool no_sync = false;
    bool joins = false;                     // -o takes many inputs and makes one output of them
    std::vector<std::string> shared;        // files that every output is made of, named by other options
    std::function<void(Task& task)> amend;  // adds the files that other options name for this task; may be empty

    void add(Command& command);
    // --files-from alone, for commands that only read; `needless` tells that this run reads nothing.
    void add_inputs(Command& command, std::function<bool()> needless = {});

    // The inputs of the command line and of --files-from. Errors: the list cannot be read.
    [[nodiscard]] Result<std::vector<std::string>> list_inputs(const Command& command) const;

    // Reads --files-from and pairs every input with its output. Throws UsageError where two inputs have one
    // output, an output is an input (also through links), or a name tells no kind of file; errors of
    // Result: the list cannot be read. Nothing is created.
    [[nodiscard]] Result<std::vector<Task>> plan(const Command& command, const OutputOptions& output_options,
                                                 const OutputDefaults& defaults) const;

    // The output that `pattern` names: below --out-dir where it is given.
    [[nodiscard]] std::string place(const std::string& pattern, const NameFields& fields) const;

    // Creates --out-dir (not its parents), and below it the folders that {dir} asks for.
    [[nodiscard]] Result<void> create_folders(const std::vector<Task>& tasks) const;

private:
    void add_list(Command& command);
    void check_inputs(const Command& command) const;
    [[nodiscard]] std::string batch_name(const std::string& input, const OutputOptions& options,
                                         const OutputDefaults& defaults) const;
};

}  // namespace tex::cli
