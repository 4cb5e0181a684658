// SPDX-License-Identifier: Apache-2.0
// foreign_words.h: what other programs call options, formats and file types, and what they are here.
//
// One table for all commands. An answer applies to a command that has every option in it; of several rows with a name,
// the first that applies counts. A name without an answer on a command is not compared with the command's options
// either: what is merely spelt like it would mislead.

#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tex::cli {

struct ForeignOption {
    std::string_view names;   // "--margin --dilation"
    std::string_view answer;  // begins with what it is here: "--padding"; or a clause
};

struct ForeignWord {
    std::string_view names;  // "dxt5 bc3"
    std::string_view word;   // "dxt5nm"
    bool is_same;            // it may be written in place of the word
};

// A word that belongs elsewhere, and where.
struct ForeignClause {
    std::string_view names;
    std::string_view among;   // a word of the lists that are meant
    std::string_view answer;  // {0}: the name
};

// A file type or an encoding that no command writes.
struct UnwrittenType {
    std::string_view names;
    std::string_view command;  // that makes it from n.png
};

[[nodiscard]] std::span<const ForeignOption> foreign_options();
[[nodiscard]] std::span<const ForeignWord> foreign_words();
[[nodiscard]] std::span<const UnwrittenType> unwritten_types();

[[nodiscard]] bool is_foreign_option(std::string_view name);

// "; here it is --padding" for a command whose options `has` knows; empty if there is no answer.
[[nodiscard]] std::string foreign_option_answer(std::string_view name,
                                                const std::function<bool(std::string_view option)>& has);
// "; here it is dxt5nm" for a word in place of `words`; empty if there is no answer.
[[nodiscard]] std::string foreign_word_answer(std::string_view name, const std::vector<std::string>& words);
// "; webp is not written: ..." for what no command writes; empty otherwise.
[[nodiscard]] std::string unwritten_type_answer(std::string_view name);

// The word for what users also call by other names or in capital letters: "up" for "OpenGL".
[[nodiscard]] std::string common_word(std::string word);

}  // namespace tex::cli
