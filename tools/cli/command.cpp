// SPDX-License-Identifier: Apache-2.0

#include "cli/command.h"

#include <algorithm>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/completion.h"
#include "cli/help.h"
#include "cli/stream.h"
#include "cli/text.h"
#include "cli/usage_error.h"
#include "cli/version.h"

namespace tex::cli {
namespace {

std::vector<std::string> split_names(const std::string& names) {
    auto [first, second] = cut(names, ',');
    return second.empty() ? std::vector<std::string>{first} : std::vector<std::string>{first, second};
}

bool is_option(std::string_view argument) { return argument.size() > 1 && argument.front() == '-'; }

}  // namespace

std::vector<std::string> names_of(const std::vector<Word>& words) {
    std::vector<std::string> names;
    names.reserve(words.size());
    for (const Word& word : words) names.push_back(word.name);
    return names;
}

void check_word(const std::string& name, const std::vector<std::string>& names) {
    if (std::find(names.begin(), names.end(), name) != names.end()) return;
    throw UsageError(fmt::format("'{}' is none of {}{}", printable(name), join(names), did_you_mean(name, names)));
}

Command::Command(std::string name, std::string summary)
    : name_(std::move(name)), summary_(std::move(summary)), app_(std::make_unique<CLI::App>()) {
    app_->set_help_flag();
    app_->allow_extras();  // inputs, and unknown options: take_inputs() tells them apart
    // CLI11 runs what belongs to an option in the order of definition: with these first, --help wins over a
    // mistake beside it.
    group(kHelpGroup);
    flag(help_, "-h,--help", "print this help and exit");
    flag(version_, "--version", "print the version and exit; with --json also how the program was built");
    text(completion_, "--completion", "SHELL", "print the completion script for bash, zsh or fish and exit").hidden =
        true;
    flag(list_options_, "--list-options", "print the option table and exit").hidden = true;
}

Command::~Command() = default;

Row& Command::option(const std::string& names, std::string value, std::string help,
                     std::function<void(const std::string& text)> take) {
    Row& row = rows_.emplace_back();
    row.group = group_;
    row.names = split_names(names);
    row.value = std::move(value);
    row.help = std::move(help);
    const auto callback = [&row, take = std::move(take)](const CLI::results_t& texts) {
        if (texts.size() > 1 && !row.repeatable)
            throw UsageError(fmt::format("{} is given more than once", row.name()));
        for (const std::string& text : texts) {
            try {
                take(text);
            } catch (const UsageError& error) {
                throw UsageError(fmt::format("{}: {}", row.name(), error.what()));
            }
        }
        return true;
    };
    // TakeAll hands every occurrence to the callback above; one value for each occurrence, so that inputs
    // may follow.
    app_->add_option(names, callback)
        ->expected(1)
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    return row;
}

Row& Command::flag(bool& target, const std::string& names, std::string help) {
    Row& row = rows_.emplace_back();
    row.group = group_;
    row.names = split_names(names);
    row.help = std::move(help);
    row.repeatable = true;
    app_->add_flag_function(names, [&target](std::int64_t) { target = true; })->disable_flag_override();
    return row;
}

Row& Command::text(std::string& target, const std::string& names, std::string value, std::string help) {
    Row& row = option(names, std::move(value), std::move(help), [&target](const std::string& text) {
        if (text.empty()) throw UsageError("needs a value that is not empty");
        target = text;
    });
    row.preset = target;
    return row;
}

Row& Command::number(float& target, const std::string& names, std::string value, Range range, std::string help) {
    Row& row = option(names, std::move(value), std::move(help),
                      [&target, range](const std::string& text) { target = parse_float(text, range); });
    row.preset = fmt::format("{}", target);
    return row;
}

Row& Command::number(int& target, const std::string& names, std::string value, int least, int greatest,
                     std::string help) {
    Row& row = option(names, std::move(value), std::move(help), [&target, least, greatest](const std::string& text) {
        target = parse_int(text, least, greatest);
    });
    row.preset = fmt::format("{}", target);
    return row;
}

Row& Command::choice_row(const std::string& names, std::string value, std::string help, std::vector<Word> words,
                         std::function<void(const std::string& name)> take) {
    std::vector<std::string> valid = names_of(words);
    Row& row = option(names, std::move(value), std::move(help),
                      [valid = std::move(valid), take = std::move(take)](const std::string& name) {
                          check_word(name, valid);
                          take(name);
                      });
    row.words = std::move(words);
    row.completes = Completes::words;
    return row;
}

const Row* Command::find(std::string_view name) const {
    for (const Row& row : rows_) {
        if (std::find(row.names.begin(), row.names.end(), name) != row.names.end()) return &row;
    }
    return nullptr;
}

// CLI11 reads "--name=" as "--name", which then takes the next argument for its value, and "--flag=false"
// as a value.
void Command::check_equals_signs(int argc, const char* const* argv) const {
    for (int k = 1; k < argc; ++k) {
        const std::string_view argument = argv[k];
        if (argument == "--") return;
        const std::size_t place = argument.find('=');
        if (!argument.starts_with("--") || place == std::string_view::npos) continue;
        const Row* row = find(argument.substr(0, place));
        if (row == nullptr) continue;
        if (row->value.empty()) throw UsageError(fmt::format("{} takes no value", row->name()));
        if (place + 1 == argument.size()) throw UsageError(fmt::format("{} needs a value after the =", row->name()));
    }
}

// What CLI11 could not assign: unknown options, inputs, and all that follows "--".
void Command::take_inputs() {
    bool only_inputs = false;
    for (const std::string& argument : app_->remaining()) {
        if (only_inputs || !is_option(argument)) {
            if (argument.empty()) throw UsageError("an input name is empty");
            inputs_.push_back(argument);
        } else if (argument == "--") {
            only_inputs = true;
        } else {
            std::vector<std::string> names;
            for (const Row& row : rows_) {
                if (!row.hidden) names.insert(names.end(), row.names.begin(), row.names.end());
            }
            const std::string name = cut(argument, '=').first;
            throw UsageError(fmt::format("unknown option {}{}", printable(name), did_you_mean(name, names)));
        }
    }
}

std::optional<ExitCode> Command::parse(int argc, const char* const* argv) {
    try {
        check_equals_signs(argc, argv);
        app_->parse(argc, argv);
    } catch (const CLI::ArgumentMismatch&) {
        // Each option takes the argument after it, whatever it is: a value can only be missing at the end.
        throw UsageError(fmt::format("{} needs a value", printable(argv[argc - 1])));
    } catch (const CLI::ParseError& error) {
        throw UsageError(printable(error.what()));
    } catch (const UsageError&) {
        if (!help_ && !version_) throw;
    }
    if (help_) return print(help_text(*this));
    if (version_) return print(given("--json") ? version_json(*this) : version_text(*this));
    if (list_options_) return print(option_list(*this));
    if (!completion_.empty()) return print(completion_script(*this, completion_));
    take_inputs();
    for (const auto& check : checks_) check();
    return std::nullopt;
}

bool Command::given(std::string_view name) const {
    const CLI::Option* option = app_->get_option_no_throw(std::string(name));
    return option != nullptr && option->count() > 0;
}

std::vector<std::string> Command::given_of(const std::vector<std::string>& names) const {
    std::vector<std::string> found;
    std::copy_if(names.begin(), names.end(), std::back_inserter(found),
                 [this](const std::string& name) { return given(name); });
    return found;
}

}  // namespace tex::cli
