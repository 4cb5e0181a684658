// SPDX-License-Identifier: Apache-2.0
// files.h: the option group of inputs and outputs. batch/plan.h pairs inputs with outputs.

#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "cli/command.h"
#include "tasks/collisions.h"
#include "tasks/name_pattern.h"
#include "tasks/task.h"
#include "tasks/udim.h"

namespace tex::cli {

struct FileOptions {
    std::string output;  // "-" for standard output, whichever of its names was given
    std::string out_dir;
    std::string name;
    std::string root;
    std::string files_from;
    bool allow_empty = false;
    std::string depfile;
    bool update = false;
    bool no_clobber = false;
    bool no_sync = false;
    bool in_place = false;       // each input is its own output
    bool reads_folders = false;  // folders among the inputs stand for the pictures in them
    // The pictures of a folder that are made from others in it, as paths; empty: none are.
    std::function<std::set<std::string>(const std::string& folder)> made_in = {};
    bool tiles = false;  // inputs are tiles of terrains, see batch/grid.h
    // Whether the run writes nothing, so that no output need be named; empty: it writes.
    std::function<bool()> writes_nothing = {};

    [[nodiscard]] bool writes() const { return !writes_nothing || !writes_nothing(); }

    // `joins`: -o can take many inputs and make one output from them; the help says so.
    void add(Command& command, bool joins = false);
    // Adds --files-from alone, for commands that only read. Inputs may be missing if `needless` returns true.
    void add_inputs(Command& command, std::function<bool()> needless = {});

    // The inputs of the command line, where <UDIM> stands for tiles and patterns that the shell left alone for files,
    // and of --files-from. Errors: the list cannot be read; there is no such file or tile. Throws UsageError if there
    // is no input at all, unless allow_empty is set: a list that a script made wrongly must not pass for success.
    [[nodiscard]] Result<std::vector<Input>> list_inputs(const Command& command) const;

    // After list_inputs(): the end of a sentence about what was left out of folders.
    [[nodiscard]] std::string left_out() const;

    // The files that names of inputs were read from: those of --files-from and @FILE.
    [[nodiscard]] std::vector<NamedFile> lists() const;

    // The fields of a name for this input. {dir} is relative to --root, or else to the input's folder if there is one.
    // Throws UsageError if the input is not in that folder.
    [[nodiscard]] NameFields fields_of(const Input& input) const;
    // Whether folders are made for outputs without --out-dir.
    [[nodiscard]] bool names_folders() const {
        return !name.empty() && (NamePattern(name).uses("dir") || NamePattern(name).uses("engine"));
    }

    // The output name that `pattern` gives, below --out-dir if that option is given.
    [[nodiscard]] std::string place(const std::string& pattern, const NameFields& fields) const;
    // The file of an option that writes besides the output, such as --height-out, whose value is `pattern`. `format` is
    // what {format} stands for.
    [[nodiscard]] std::string further(const std::string& option, const std::string& pattern, const Task& task,
                                      std::string_view format = {}) const;

private:
    void add_list(Command& command);
    [[nodiscard]] Result<void> list_folder(const std::string& folder, std::vector<Input>& inputs) const;
    void check(const Command& command);
    void check_inputs(const Command& command);

    std::vector<std::string> argument_files_;
    mutable std::int64_t other_files_ = 0, made_files_ = 0, linked_files_ = 0;  // what was left out of folders
};

}  // namespace tex::cli
