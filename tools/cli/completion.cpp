// SPDX-License-Identifier: Apache-2.0

#include "cli/completion.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "cli/text.h"

namespace tex::cli {
namespace {

std::string replace_all(std::string text, std::string_view from, std::string_view to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
        text.replace(at, from.size(), to);
    return text;
}

// bash: a function that looks at the option before the cursor. bash passes "--name=word" as three words.
std::string bash_script(const Command& command) {
    const std::string function = fmt::format("_{}", replace_all(command.name(), "-", "_"));
    std::string cases, files, directories, others;
    std::vector<std::string> options;
    for (const Option& row : command.options()) {
        if (row.hidden) continue;
        options.insert(options.end(), row.names.begin(), row.names.end());
        const std::string pattern = join(row.names, "|");
        if (row.value.empty()) continue;
        if (row.completes == Completes::words) {
            cases += fmt::format("        {}) mapfile -t COMPREPLY < <(compgen -W '{}' -- \"$cur\"); return ;;\n",
                                 pattern, join(names_of(row.words), " "));
        } else {
            std::string& list = row.completes == Completes::files         ? files
                                : row.completes == Completes::directories ? directories
                                                                          : others;
            list += (list.empty() ? "" : "|") + pattern;
        }
    }
    if (!directories.empty()) {
        cases += fmt::format(
            "        {}) compopt -o filenames; mapfile -t COMPREPLY < <(compgen -d -- \"$cur\"); return ;;\n",
            directories);
    }
    if (!others.empty()) cases += fmt::format("        {}) return ;;\n", others);
    if (!files.empty()) cases += fmt::format("        {}) cur_is_file=1 ;;\n", files);
    return fmt::format(
        "# bash completion for {0}\n"
        "{1}() {{\n"
        "    local cur=${{COMP_WORDS[COMP_CWORD]}} prev=${{COMP_WORDS[COMP_CWORD-1]}} cur_is_file=\n"
        "    if [[ $cur == = ]]; then\n"
        "        cur=\n"
        "    elif [[ $prev == = ]]; then\n"
        "        prev=${{COMP_WORDS[COMP_CWORD-2]}}\n"
        "    fi\n"
        "    COMPREPLY=()\n"
        "    case $prev in\n"
        "{2}"
        "    esac\n"
        "    if [[ $cur == -* && -z $cur_is_file ]]; then\n"
        "        mapfile -t COMPREPLY < <(compgen -W '{3}' -- \"$cur\")\n"
        "    else\n"
        "        compopt -o filenames\n"
        "        mapfile -t COMPREPLY < <(compgen -f -- \"$cur\")\n"
        "    fi\n"
        "}}\n"
        "complete -F {1} {0}\n",
        command.name(), function, cases, join(options, " "));
}

// zsh: one _arguments specification for each option, in single quotes. Inside it, [ ] and : are special.
std::string zsh_escaped(std::string text) {
    for (const std::string_view special : {"\\", "[", "]", ":"})
        text = replace_all(text, special, fmt::format("\\{}", special));
    return replace_all(text, "'", "'\\''");
}

std::string zsh_action(const Option& row) {
    if (row.completes == Completes::files) return "_files";
    if (row.completes == Completes::directories) return "_files -/";
    if (row.completes == Completes::nothing) return " ";
    std::string action;
    for (const Word& word : row.words) {
        // Only these four characters are special inside the double quotes of a description.
        std::string meaning = word.meaning;
        for (const std::string_view special : {"\\", "\"", "$", "`"}) {
            meaning = replace_all(meaning, special, fmt::format("\\{}", special));
        }
        meaning = replace_all(replace_all(meaning, ":", "\\:"), "'", "'\\''");
        action += fmt::format("{}{}\\:\"{}\"", action.empty() ? "" : " ", word.name, meaning);
    }
    return fmt::format("(({}))", action);
}

std::string zsh_script(const Command& command) {
    std::string out = fmt::format("#compdef {}\n\n_arguments -S \\\n", command.name());
    for (const Option& row : command.options()) {
        if (row.hidden) continue;
        for (const std::string& name : row.names) {
            const std::string others =
                row.names.size() > 1 && !row.repeatable ? fmt::format("({})", join(row.names, " ")) : "";
            const char* equals = row.value.empty() ? "" : name.starts_with("--") ? "=" : "+";
            out += fmt::format("    '{}{}{}{}[{}]", row.repeatable && !row.value.empty() ? "*" : "", others, name,
                               equals, zsh_escaped(row.help));
            if (!row.value.empty()) out += fmt::format(":{}:{}", zsh_escaped(row.value), zsh_action(row));
            out += "' \\\n";
        }
    }
    return out + "    '*:input:_files'\n";
}

std::string fish_quoted(std::string text) {
    return fmt::format("'{}'", replace_all(replace_all(std::move(text), "\\", "\\\\"), "'", "\\'"));
}

std::string fish_script(const Command& command) {
    std::string out = fmt::format("# fish completion for {}\n", command.name());
    for (const Option& row : command.options()) {
        if (row.hidden) continue;
        out += fmt::format("complete -c {}", command.name());
        for (const std::string& name : row.names) {
            out +=
                name.starts_with("--") ? fmt::format(" -l {}", name.substr(2)) : fmt::format(" -s {}", name.substr(1));
        }
        if (!row.value.empty())
            out += row.completes == Completes::files || row.completes == Completes::directories ? " -r -F" : " -x";
        if (!row.words.empty()) {
            std::string list;  // one candidate on each line, with its meaning after a tab
            for (const Word& word : row.words)
                list += fmt::format("{}{}\t{}", list.empty() ? "" : "\n", word.name, word.meaning);
            out += " -a " + fish_quoted(list);
        }
        out += " -d " + fish_quoted(row.help) + "\n";
    }
    return out;
}

}  // namespace

std::string completion_script(const Command& command, const std::string& shell) {
    if (shell == "bash") return bash_script(command);
    return shell == "zsh" ? zsh_script(command) : fish_script(command);
}

}  // namespace tex::cli
