// SPDX-License-Identifier: Apache-2.0

#include "cli/command.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "cli/completion.h"
#include "cli/foreign_words.h"
#include "cli/help.h"
#include "cli/help_json.h"
#include "cli/text.h"
#include "cli/text_file.h"
#include "cli/usage_error.h"
#include "cli/version.h"

namespace tex::cli {
namespace {

template <class Rows>
auto* find_row(Rows& rows, std::string_view name) {
    const auto found = std::find_if(rows.begin(), rows.end(), [name](const Option& row) {
        return std::find(row.names.begin(), row.names.end(), name) != row.names.end();
    });
    return found == rows.end() ? nullptr : &*found;
}

bool is_option(std::string_view argument) { return argument.size() > 1 && argument.front() == '-'; }

// The value of `row` that the argument itself contains, if it contains one.
std::optional<std::string> value_of(const Option& row, std::string_view argument) {
    const bool is_long = argument.starts_with("--");
    const std::size_t place = is_long ? argument.find('=') : 2;
    const bool is_flag = row.value.empty();
    if (is_flag && !is_long) return "";  // the only such flag is -h; the characters after it do not matter
    if (place >= argument.size()) return is_flag ? std::optional<std::string>("") : std::nullopt;
    if (is_flag) throw UsageError(fmt::format("{} takes no value", row.name()));
    const std::string_view value = argument.substr(is_long ? place + 1 : place);
    if (value.empty()) throw UsageError(fmt::format("{} needs a value after the =", row.name()));
    return std::string(value);
}

}  // namespace

std::vector<std::string> names_of(const std::vector<Word>& words) {
    std::vector<std::string> names;
    names.reserve(words.size());
    for (const Word& word : words) names.push_back(word.name);
    return names;
}

std::string known_word(const std::string& name, const std::vector<std::string>& names) {
    for (const std::string& word : {name, common_word(name)}) {
        if (std::find(names.begin(), names.end(), word) != names.end()) return word;
    }
    const std::string answer = foreign_word_answer(name, names);
    throw UsageError(fmt::format("must be one of {}, not '{}'{}", join(names), printable(name),
                                 answer.empty() ? did_you_mean(name, names) : answer));
}

Command::Command(std::string_view name, std::string_view summary) : name_(name), summary_(summary) {
    // These rows come first because values are taken in the order of the rows. So --help works even if another option
    // is wrong.
    group(kHelpGroup);
    flag(help_, "-h,--help",
         "print all options (-h: one screen with the most used ones) and exit; with --json, as data");
    flag(version_, "--version", "print the version and exit; with --json also how the program was built");
    choice_row("--completion", "SHELL", "print a completion script and exit", {{"bash", ""}, {"zsh", ""}, {"fish", ""}},
               [this](const std::string& shell) { completion_ = shell; })
        .hidden = true;
    flag(list_options_, "--list-options", "print the option table and exit").hidden = true;
}

Option& Command::option(const std::string& names, std::string value, std::string help,
                        std::function<void(const std::string& text)> take) {
    Option& row = options_.emplace_back();
    row.group = group_;
    row.names = split(names, ',');
    row.value = std::move(value);
    row.help = std::move(help);
    row.take = std::move(take);
    return row;
}

Option& Command::flag(bool& target, const std::string& names, std::string help) {
    Option& row = option(names, {}, std::move(help), [&target](const std::string&) { target = true; });
    row.repeatable = true;
    return row;
}

Option& Command::text(std::string& target, const std::string& names, std::string value, std::string help) {
    Option& row = option(names, std::move(value), std::move(help), [&target](const std::string& text) {
        if (text.empty()) throw UsageError("needs a value that is not empty");
        target = text;
    });
    row.preset = target;
    return row;
}

Option& Command::output_file(std::string& target, const std::string& names, std::string help) {
    Option& row = text(target, names, "FILE", std::move(help));
    row.completes = Completes::files;
    row.writes = true;
    return row;
}

Option& Command::number(float& target, const std::string& names, std::string value, Range range, std::string help) {
    Option& row = option(names, std::move(value), std::move(help),
                         [&target, range](const std::string& text) { target = parse_float(text, range); });
    row.preset = fmt::format("{}", target);
    return row;
}

Option& Command::number(int& target, const std::string& names, std::string value, int least, int greatest,
                        std::string help) {
    Option& row = option(names, std::move(value), std::move(help), [&target, least, greatest](const std::string& text) {
        target = parse_int(text, least, greatest);
    });
    row.preset = fmt::format("{}", target);
    return row;
}

Option& Command::number(int& target, const std::string& names, std::string value, Range range, std::string help) {
    Option& row = option(names, std::move(value), std::move(help),
                         [&target, range](const std::string& text) { target = parse_int(text, range); });
    row.preset = fmt::format("{}", target);
    return row;
}

Option& Command::choice_row(const std::string& names, std::string value, std::string help, std::vector<Word> words,
                            std::function<void(const std::string& name)> take) {
    std::vector<std::string> valid = names_of(words);
    Option& row = option(
        names, std::move(value), std::move(help),
        [valid = std::move(valid), take = std::move(take)](const std::string& name) { take(known_word(name, valid)); });
    row.words = std::move(words);
    row.completes = Completes::words;
    return row;
}

std::string Command::unknown_option(std::string name) const {
    const bool is_number_in_it =
        !name.starts_with("--") && name.size() > 2 && name.find_first_not_of("0123456789", 2) == std::string::npos;
    if (is_number_in_it) name.resize(2);  // -j8
    std::string text = "unknown option " + printable(name);
    if (is_foreign_option(name))
        return text + foreign_option_answer(name, [this](std::string_view option) {
                   const Option* row = find_row(options_, option);
                   return row != nullptr && !row->hidden;
               });
    std::vector<std::string> names;
    for (const Option& row : options_) {
        if (!row.hidden) names.insert(names.end(), row.names.begin(), row.names.end());
    }
    return text + did_you_mean(name, names);
}

Result<std::vector<std::string>> Command::arguments_in(const std::string& file) {
    if (file == "-" && has_read_standard_input_) throw UsageError("standard input can only be read once");
    has_read_standard_input_ = has_read_standard_input_ || file == "-";
    if (file != "-") argument_files_.push_back(file);
    const auto text = read_text_file(file);
    if (!text) return text.error();
    return list_of(*text);
}

// Gives each row its values, and keeps the inputs. Returns the first mistake that --help overrides: an unknown option
// or an empty name. Errors: a file of arguments cannot be read.
Result<std::string> Command::sort(Arguments given) {
    std::vector<std::string> arguments(given.begin(), given.end());
    std::size_t from_file = 0;  // the arguments before this place are from a file, or were looked at
    std::string mistake;
    bool only_inputs = false;
    for (std::size_t k = 0; k < arguments.size(); ++k) {
        const std::string argument = arguments[k];
        if (!only_inputs && k >= from_file && argument.size() > 1 && argument.front() == '@') {
            const auto more = arguments_in(argument.substr(1));
            if (!more) return more.error();
            const auto place = arguments.begin() + static_cast<std::ptrdiff_t>(k);
            arguments.insert(arguments.erase(place), more->begin(), more->end());
            from_file = k + more->size();
            --k;
            continue;
        }
        if (only_inputs || !is_option(argument)) {
            if (argument.empty() && mistake.empty()) mistake = "an input name is empty";
            inputs_.push_back(argument);
            continue;
        }
        only_inputs = argument == "--";
        if (only_inputs) continue;
        const bool is_long = argument.starts_with("--");
        Option* row = find_row(options_, argument.substr(0, is_long ? argument.find('=') : 2));
        if (row == nullptr) {
            if (mistake.empty()) mistake = unknown_option(cut(argument, '=').first);
            continue;
        }
        auto value = value_of(*row, argument);
        if (!value && ++k == arguments.size()) throw UsageError(fmt::format("{} needs a value", printable(argument)));
        helps_in_full_ = helps_in_full_ || argument == "--help";
        row->given.push_back(value ? std::move(*value) : arguments[k]);
    }
    return mistake;
}

void Command::answer(std::string text) {
    if (!answers_) throw UsageError("only prints something and ends, which cannot be used here");
    answer_ = std::move(text);
}

void Command::take_values() {
    for (const Option& row : options_) {
        if (row.given.size() > 1 && !row.repeatable)
            throw UsageError(fmt::format("{} is given more than once", row.name()));
        for (const std::string& text : row.given) {
            try {
                row.take(text);
            } catch (const UsageError& error) {
                throw UsageError(row.name(), error.what());
            }
        }
    }
}

std::optional<ExitCode> Command::parse(Arguments arguments, Console& console) {
    const Result<std::string> sorted = sort(arguments);
    if (!sorted) {
        console.error(sorted.error().message());
        return exit_code(sorted.error().code);
    }
    try {
        take_values();
    } catch (const UsageError&) {
        if (!help_ && !version_) throw;
    }
    if (help_) {
        if (given("--json")) return console.print(help_json(*this));
        return console.print(helps_in_full_ ? help_text(*this) : brief_help_text(*this));
    }
    if (version_) return console.print(given("--json") ? version_json(*this) : version_text(*this));
    if (list_options_) return console.print(option_list(*this));
    if (!completion_.empty()) return console.print(completion_script(*this, completion_));
    if (!sorted->empty()) throw UsageError(*sorted);
    if (!answer_.empty()) return console.print(answer_);
    if (has_read_standard_input_ && std::find(inputs_.begin(), inputs_.end(), "-") != inputs_.end())
        throw UsageError("standard input can only be read once");
    for (const auto& check : checks_) check();
    return std::nullopt;
}

void Command::drop_table() {
    std::deque<Option> all;
    all.swap(options_);
    checks_.clear();
    for (Option& row : all) {
        if (row.given.empty()) continue;
        Option& kept = options_.emplace_back();
        kept.names = std::move(row.names);
        kept.given = std::move(row.given);
    }
}

bool Command::given(std::string_view name) const {
    const Option* row = find_row(options_, name);
    return row != nullptr && !row->given.empty();
}

std::vector<std::string> Command::given_of(const std::vector<std::string>& names) const {
    std::vector<std::string> found;
    std::copy_if(names.begin(), names.end(), std::back_inserter(found),
                 [this](const std::string& name) { return given(name); });
    return found;
}

}  // namespace tex::cli
