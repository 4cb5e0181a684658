// SPDX-License-Identifier: Apache-2.0
// recipe.h: a rule of the manifest as commands that are ready to run.
//
// The keys of a rule become a command line, which the command itself reads. So a key is an option, with the same words,
// limits and messages, and an option that a command gains is a key at once.

#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "batch/batch.h"
#include "cli/console.h"
#include "cli/glob.h"
#include "cli/programs.h"
#include "cli/text.h"
#include "tasks/name_pattern.h"
#include "tree/changes.h"
#include "tree/manifest.h"
#include "tree/texture_check.h"

namespace tex::cli {

// The names of steps: "bake" for bake-normals. These are the commands that make an output from each input.
[[nodiscard]] std::vector<std::string> step_names();

// Commands whose options have been read. Outputs with the same settings share one, and all of them share the table of
// their step, which takes 40 KB.
class ProgramPool {
public:
    // The table of a step, to look up options; nothing has been given.
    [[nodiscard]] const Command& table_of(const std::string& step);
    // The program that was made for the same step with the same arguments; null if it is to be made.
    [[nodiscard]] std::shared_ptr<Program>& program_for(const std::string& step,
                                                        const std::vector<std::string>& arguments);

private:
    std::map<std::string, std::unique_ptr<Program>> tables_;
    std::map<std::pair<std::string, std::vector<std::string>>, std::shared_ptr<Program>> programs_;
};

// A command whose options have been read.
struct ReadyCommand {
    std::shared_ptr<Program> program;    // without its table
    Converter* converter = nullptr;      // the program
    std::vector<std::string> arguments;  // the options as the manifest gives them, sorted by name
    std::vector<std::string> writes =
        {};                      // those of them that name files to write (Option::writes), such as --height-out
    std::string extension = {};  // what an output name without an extension gets; else empty
};

// The files of an output, below the root or as paths.
struct OutputFiles {
    std::vector<std::string> levels;  // with kLevelMark: there is a file for each level
    std::vector<std::string> files;   // the others: the output itself, maps beside it; for each UDIM tile

    // All that may exist.
    [[nodiscard]] std::vector<std::string> all() const;
    void add(std::string name) { (has_level(name) ? levels : files).push_back(std::move(name)); }
};

// One output of a rule.
struct RecipeOutput {
    ReadyCommand last;     // the last step, with the settings of this output
    NamePattern name;      // below out_dir
    std::string settings;  // what its bytes depend on, besides the contents of files
    std::string data;      // the same of what is beside the normals: outputs of one flow have the same
    std::string out;       // its name, if the input is called "name"
    NamedValues named;     // the same for people
    TextPosition place;
};

class Recipe {
public:
    // `number` counts the rules from 1. Paths in options are relative to `root`, the folder of the manifest (empty: the
    // working directory). The pool is used as long as the recipe. Throws UsageError with the place in the manifest.
    Recipe(const Manifest& manifest, const RuleSettings& rule, int number, const std::string& root, ProgramPool& pool,
           Console& console);
    Recipe(Recipe&&) = default;
    Recipe(const Recipe&) = delete;
    ~Recipe() = default;

    [[nodiscard]] int number() const { return number_; }
    [[nodiscard]] const RuleSettings& rule() const { return rule_; }
    [[nodiscard]] const std::vector<Glob>& match() const { return match_; }
    [[nodiscard]] bool takes(const std::string& input) const;
    [[nodiscard]] bool excludes(const std::string& input) const;
    // Throws a UsageError with the place of the rule.
    [[noreturn]] void fail(const std::string& reason) const { fail_at(manifest_.path, rule_.place, reason); }

    [[nodiscard]] const std::vector<ReadyCommand>& before() const { return before_; }  // the steps before the last
    [[nodiscard]] const std::vector<RecipeOutput>& outputs() const { return outputs_; }
    // The name of an output of `input`, relative to the root. It contains kLevelMark if each level has its own file,
    // and <UDIM> if each tile of a mesh has. Throws UsageError if it leads out of the root.
    [[nodiscard]] std::string output_name(const std::string& input, std::size_t output) const;
    // The files of such an output, relative to the root. Those of tiles depend on the mesh, which is read if it has
    // changed. Throws UsageError if one leads out of the root.
    // Adds the file of each option that writes to `further`.
    [[nodiscard]] OutputFiles files_of(const std::string& input, std::size_t output,
                                       std::map<std::string, std::string>* further = nullptr) const;
    // The tasks of the last step that make the output `to` from the file `path`: one, or one for each tile of a mesh.
    // They write each file of files_of(), in this order.
    [[nodiscard]] std::vector<Task> tasks_of(const std::string& path, std::size_t output, const std::string& to,
                                             std::map<std::string, std::string>* further = nullptr) const;

    // The task of the first step, with the tiles around `path` if it is a tile of a terrain. `path` leads to the input.
    [[nodiscard]] Task first_task(const Converter& converter, const std::string& path, const std::string& out) const;

    // Whether these are the names of all files of an output: one of each, or one for each level or tile.
    [[nodiscard]] bool are_files_of(const std::string& input, std::size_t output,
                                    const std::vector<std::string>& names) const;
    // The name below out-dir of a file that the rule can make of an input of this name; none if it cannot. Neither need
    // exist. Both names may come from a file that anybody can write, such as the state.
    [[nodiscard]] std::optional<std::string> name_below_out_dir(const std::string& input,
                                                                const std::string& file) const;

    [[nodiscard]] const TextureCheck& check() const { return *check_; }
    // Whether the inputs are normal maps.
    [[nodiscard]] bool reads_normals() const;
    // Where the rule stands: "build.toml, line 7".
    [[nodiscard]] std::string place_text() const {
        return printable(manifest_.path) + ", line " + std::to_string(rule_.place.line);
    }

    // The files that options name and every output depends on, relative to the root.
    [[nodiscard]] const std::vector<std::string>& files() const { return files_; }
    // The other files that the outputs of one input depend on, relative to the root: further parts of the input
    // (other_parts.h), and those that options name by a pattern, such as the high mesh of a low one. `path` leads to
    // the input.
    [[nodiscard]] std::vector<std::string> own_files(const std::string& input, const std::string& path) const;
    // Where a file is whose name is relative to the root.
    [[nodiscard]] std::string path_to(const std::string& name) const;
    // The value that a setting of RecipeOutput::named has if it is not given, in the words of --help; may be empty.
    [[nodiscard]] std::string preset_of(const std::string& name) const;
    // The options of a step's command.
    [[nodiscard]] const Command& table_of(const std::string& step) const { return pool_.table_of(step); }
    // The command lines that do the same, one for each step, for people.
    [[nodiscard]] std::vector<std::string> command_lines(const std::string& input, std::size_t output) const;

private:
    // An intermediate result, of which only the type and the encoding count. No such file exists.
    static constexpr const char* kBetween = "between.exr";

    [[nodiscard]] ReadyCommand ready(const StepSettings& step, const OutputSettings* output, bool is_last,
                                     const std::string& out, Console& console) const;
    [[nodiscard]] std::shared_ptr<Program> parsed(const StepSettings& step, std::vector<std::string> line,
                                                  const std::string& out, Console& console) const;
    [[nodiscard]] std::shared_ptr<const FurtherPlaces> trial_places(const Command& command) const;
    [[nodiscard]] std::shared_ptr<const FurtherPlaces> further_places(const std::string& input,
                                                                      std::map<std::string, std::string>* names) const;
    [[nodiscard]] std::vector<int> tiles_of(const ReadyCommand& command, const std::string& path,
                                            const std::string& to) const;
    [[nodiscard]] std::string below_out_dir(const std::string& name) const;
    [[nodiscard]] bool matches(const std::string& input) const;
    [[nodiscard]] Task task_of(const std::string& path, std::size_t output, const std::string& to, int tile,
                               std::map<std::string, std::string>* further) const;
    [[nodiscard]] OutputFiles marked_files_of(const std::string& input, std::size_t output) const;
    [[nodiscard]] std::string_view format_between(const std::vector<std::string>& arguments) const;
    void add_option(const OptionSetting& setting, const Command& command, const std::vector<std::string>& groups,
                    std::vector<std::string>& arguments) const;
    [[nodiscard]] std::string with_root(const std::string& argument, const Command& command) const;
    void check_tiles(const ReadyCommand& first) const;
    void check_order(const StepSettings& step, const ReadyCommand& command, std::size_t index, Console& console) const;
    void add_output(const OutputSettings& output, Console& console);
    void find_files();
    [[nodiscard]] std::string below_root(const std::string& file) const;
    [[nodiscard]] std::vector<std::string> prerequisites_of(const std::string& path) const;
    void check_folder(const NamePattern& name, const std::string& out, const TextPosition& place) const;
    [[nodiscard]] NamedValues named_settings(const ReadyCommand& last, const Task& task) const;

    const Manifest& manifest_;
    const RuleSettings& rule_;
    const int number_;
    const std::string root_;
    ProgramPool& pool_;
    std::vector<Glob> match_, exclude_;
    std::vector<std::string> grids_;  // the patterns of match_ with {x} and {y}: tiles of terrains
    std::unique_ptr<TextureCheck> check_;
    std::vector<ReadyCommand> before_;
    std::vector<RecipeOutput> outputs_;
    std::vector<std::string> files_;
};

}  // namespace tex::cli
