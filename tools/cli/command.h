// SPDX-License-Identifier: Apache-2.0
// command.h: the table of a command's options, and the parser that reads a command line with it.
//
// One row holds everything about an option: its names, its value, its meaning, its default and the words that it
// accepts. The parser, --help, the shell completions, --list-options and (through --list-options) the test of the man
// pages all read these rows. The default is the value that the target holds when its row is added, which is the
// library's own default.
//
// The value of an option is the next argument, whatever it is, or the rest of the same argument: "--name VALUE",
// "--name=VALUE", "-o FILE", "-oFILE". Everything after "--" is an input. Before that, "@FILE" stands for the arguments
// in FILE, one a line or separated by NUL; "@-" reads standard input.

#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <tex/types.h>

#include "cli/console.h"
#include "cli/exit_code.h"
#include "cli/value.h"

namespace tex::cli {

// A command line without the name of the program.
using Arguments = std::span<const char* const>;

// A word that an option accepts, and its meaning.
struct Word {
    std::string name;
    std::string meaning;
};

// The rows of a table, or those whose value `fits`.
template <class E, std::size_t N>
[[nodiscard]] std::vector<Word> words_of(const Named<E> (&table)[N], bool (*fits)(E) = nullptr) {
    std::vector<Word> words;
    for (const Named<E>& row : table) {
        if (fits == nullptr || fits(row.value)) words.push_back({std::string(row.name), std::string(row.meaning)});
    }
    return words;
}
[[nodiscard]] std::vector<std::string> names_of(const std::vector<Word>& words);

enum class Completes { nothing, words, files, directories };

// An option of a command: a row of its table.
struct Option {
    std::string group;                // heading in the help
    std::vector<std::string> names;   // "-o", "--output"
    std::string value;                // placeholder of the value: "FILE"; empty for a flag
    std::string help;                 // a clause without a final full stop; `words` and `preset` are added to it
    std::string preset;               // the default as a user would type it, or empty
    std::vector<Word> words;          // the words that the option accepts
    std::vector<std::string> rivals;  // options ("--size") that are used instead of it: its default then means nothing
    Completes completes = Completes::nothing;
    int rank = 0;             // among the options that most people use, from 1; 0: it is none of them
    std::string brief;        // what -h prints of them, as short as a line
    bool hidden = false;      // left out of the help
    bool repeatable = false;  // may be given more than once
    // The value names a file that is written. This is the only list of such options: the manifest makes outputs of
    // those that a step can have, and --help --json prints them.
    bool writes = false;

    std::vector<std::string> given;                     // the values on the command line, in order; empty for a flag
    std::function<void(const std::string& text)> take;  // called with each value; throws UsageError

    [[nodiscard]] const std::string& name() const { return names.back(); }  // the long one
    // Marks an option that most people use. -h prints those with the least ranks.
    Option& often(int its_rank, std::string clause) {
        rank = its_rank;
        brief = std::move(clause);
        return *this;
    }
};

// The group of --help and similar options, which the help lists last.
inline constexpr const char* kHelpGroup = "Help";

struct Example {
    std::string line;
    std::string meaning;
};

class Command {
public:
    // `summary` is a sentence: "Turns height maps into normal maps."
    Command(std::string_view name, std::string_view summary);
    ~Command() = default;
    Command(const Command&) = delete;
    Command& operator=(const Command&) = delete;

    void usage(std::string line) { usages_.push_back(std::move(line)); }
    // Describes the positional arguments: "HEIGHT...", "height maps; - is standard input".
    void input(std::string value, std::string help) { input_ = {std::move(value), std::move(help)}; }
    // -h prints the first three, so these are short.
    void example(std::string line, std::string meaning) { examples_.push_back({std::move(line), std::move(meaning)}); }
    void finds_things() { finds_ = true; }  // the command can end with ExitCode::findings
    void group(std::string title) { group_ = std::move(title); }

    // Adds an option with a value. `take` gets the text and throws UsageError. References to rows stay valid.
    Option& option(const std::string& names, std::string value, std::string help,
                   std::function<void(const std::string& text)> take);
    Option& flag(bool& target, const std::string& names, std::string help);
    Option& text(std::string& target, const std::string& names, std::string value, std::string help);
    // A file that is written.
    Option& output_file(std::string& target, const std::string& names, std::string help);
    Option& number(float& target, const std::string& names, std::string value, Range range, std::string help);
    Option& number(int& target, const std::string& names, std::string value, int least, int greatest, std::string help);
    Option& number(int& target, const std::string& names, std::string value, Range range, std::string help);
    template <class E, std::size_t N>
    Option& choice(E& target, const std::string& names, const std::string& value, const Named<E> (&table)[N],
                   const std::string& help, bool (*fits)(E) = nullptr) {
        Option& row = choice_row(names, value, help, words_of(table, fits),
                                 [&target, &table](const std::string& name) { target = *find_by_name(table, name); });
        row.preset = name_of(table, target);
        return row;
    }
    template <class E, std::size_t N>
    Option& choice(std::optional<E>& target, const std::string& names, const std::string& value,
                   const Named<E> (&table)[N], const std::string& help) {
        return choice_row(names, value, help, words_of(table),
                          [&target, &table](const std::string& name) { target = *find_by_name(table, name); });
    }

    // `body` is called after all options have been read. It throws UsageError if they contradict each other, and
    // changes nothing.
    void check(std::function<void()> body) { checks_.push_back(std::move(body)); }

    // What an option prints instead of the command's work: parse() prints it and ends. Options call this when their
    // value is taken. Throws UsageError after forbid_answers().
    void answer(std::string text);
    void forbid_answers() { answers_ = false; }

    // Reads the command line. Call it once. Returns an exit code if nothing is left to do, because --help, --version or
    // a similar option has printed its text. Throws UsageError.
    [[nodiscard]] std::optional<ExitCode> parse(Arguments arguments, Console& console);

    // After parse(): forgets the rows but for the names and values of the options that were given. What is left takes
    // a tenth of the memory.
    void drop_table();

    [[nodiscard]] bool given(std::string_view name) const;
    // The options in `names` that were given.
    [[nodiscard]] std::vector<std::string> given_of(const std::vector<std::string>& names) const;
    [[nodiscard]] const std::vector<std::string>& inputs() const { return inputs_; }
    // The files that arguments were read from: those of @FILE.
    [[nodiscard]] const std::vector<std::string>& argument_files() const { return argument_files_; }
    // Whether @- was given.
    [[nodiscard]] bool has_read_standard_input() const { return has_read_standard_input_; }

    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] const std::string& summary() const { return summary_; }
    [[nodiscard]] const std::vector<std::string>& usages() const { return usages_; }
    [[nodiscard]] const std::vector<Example>& examples() const { return examples_; }
    [[nodiscard]] const Word& input() const { return input_; }
    [[nodiscard]] bool finds() const { return finds_; }
    [[nodiscard]] const std::deque<Option>& options() const { return options_; }

private:
    Option& choice_row(const std::string& names, std::string value, std::string help, std::vector<Word> words,
                       std::function<void(const std::string& name)> take);
    [[nodiscard]] Result<std::vector<std::string>> arguments_in(const std::string& file);
    [[nodiscard]] Result<std::string> sort(Arguments given);
    [[nodiscard]] std::string unknown_option(std::string name) const;
    void take_values();

    std::string name_;
    std::string summary_;
    std::string group_;
    std::vector<std::string> usages_;
    std::vector<Example> examples_;
    Word input_;
    std::vector<std::string> inputs_;
    std::deque<Option> options_;
    std::vector<std::function<void()>> checks_;
    bool finds_ = false;
    bool has_read_standard_input_ = false;
    std::vector<std::string> argument_files_;
    bool help_ = false;
    bool helps_in_full_ = false;  // --help, not only -h
    bool version_ = false;
    bool list_options_ = false;
    bool answers_ = true;
    std::string answer_;
    std::string completion_;
};

// The one of `names` that `name` or common_word(name) (foreign_words.h) is. Throws UsageError, which lists the names
// and suggests one.
[[nodiscard]] std::string known_word(const std::string& name, const std::vector<std::string>& names);
template <class E, std::size_t N>
[[nodiscard]] E parse_word(const std::string& name, const Named<E> (&table)[N]) {
    return *find_by_name(table, known_word(name, names_of(words_of(table))));
}

}  // namespace tex::cli
