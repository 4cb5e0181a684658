// SPDX-License-Identifier: Apache-2.0

#include "cli/glob.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "cli/text.h"
#include "cli/usage_error.h"
#include "cli/value.h"
#include "files/path_names.h"

namespace tex::cli {
namespace {

constexpr std::size_t kMostAlternatives = 1024;
constexpr std::size_t kMostOfPattern = 4096;  // bytes: the longest path that the system takes
constexpr std::size_t kMostNested = 16;       // braces in braces
constexpr std::size_t kMostShown = 200;       // characters of a pattern in messages

std::string shown(std::string_view pattern) {
    std::string text = printable(std::string(pattern.substr(0, kMostShown)));
    return pattern.size() > kMostShown ? text + "..." : text;
}

// Returns the end of the braces that open at `begin`, or npos.
std::size_t closing_brace(std::string_view text, std::size_t begin) {
    int depth = 0;
    for (std::size_t k = begin; k < text.size(); ++k) {
        if (text[k] == '\\') {
            ++k;
        } else if (text[k] == '{') {
            ++depth;
        } else if (text[k] == '}' && --depth == 0) {
            return k;
        }
    }
    return std::string_view::npos;
}

// Splits "a,{b,c}" at the commas outside inner braces.
std::vector<std::string_view> choices_of(std::string_view inside) {
    std::vector<std::string_view> choices;
    int depth = 0;
    std::size_t begin = 0;
    for (std::size_t k = 0; k < inside.size(); ++k) {
        if (inside[k] == '\\') {
            ++k;
        } else if (inside[k] == '{') {
            ++depth;
        } else if (inside[k] == '}') {
            --depth;
        } else if (inside[k] == ',' && depth == 0) {
            choices.push_back(inside.substr(begin, k - begin));
            begin = k + 1;
        }
    }
    choices.push_back(inside.substr(begin));
    return choices;
}

// The number of patterns that a text with braces stands for, without making them. A sequence stands for the product of
// its parts, braces for the sum of their choices. Numbers above kMostAlternatives are not exact.
std::size_t count_patterns(std::string_view text) {
    struct Level {
        std::size_t sum = 0, product = 1;
    };
    std::vector<Level> levels(1);
    for (std::size_t k = 0; k < text.size(); ++k) {
        Level& level = levels.back();
        if (text[k] == '\\') {
            ++k;
        } else if (text[k] == '{') {
            levels.emplace_back();
            if (levels.size() > kMostNested + 1)
                throw UsageError(fmt::format("'{}' nests braces in more than {} levels", shown(text), kMostNested));
        } else if (text[k] == ',' && levels.size() > 1) {
            level.sum += std::exchange(level.product, 1);
        } else if (text[k] == '}' && levels.size() > 1) {
            const std::size_t choices = level.sum + level.product;
            levels.pop_back();
            levels.back().product = std::min(levels.back().product * choices, kMostAlternatives + 1);
        }
    }
    return levels.front().product;
}

// Replaces braces by their choices, the first braces first.
std::vector<std::string> without_braces(const std::string& text) {
    if (count_patterns(text) > kMostAlternatives)
        throw UsageError(fmt::format("'{}' stands for more than {} patterns", shown(text), kMostAlternatives));
    std::vector<std::string> ready, open = {text};
    while (!open.empty()) {
        const std::string one = std::move(open.back());
        open.pop_back();
        std::size_t begin = 0;
        while (begin < one.size() && one[begin] != '{') begin += one[begin] == '\\' ? 2 : 1;
        if (begin >= one.size()) {
            ready.push_back(one);
            continue;
        }
        const std::size_t end = closing_brace(one, begin);
        if (end == std::string::npos) throw UsageError(fmt::format("'{}' has a {{ without its }}", shown(text)));
        for (const std::string_view choice : choices_of(std::string_view(one).substr(begin + 1, end - begin - 1)))
            open.push_back(one.substr(0, begin) + std::string(choice) + one.substr(end + 1));
    }
    return ready;
}

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

// One character class, "[a-z]". `at` is the place after the bracket; it is moved past the end. Returns nothing if there
// is no end.
struct ClassMatch {
    bool matches = false;
    std::size_t end = std::string_view::npos;
};
ClassMatch match_class(std::string_view pattern, std::size_t at, char c) {
    const bool negated = at < pattern.size() && (pattern[at] == '!' || pattern[at] == '^');
    if (negated) ++at;
    bool found = false;
    for (bool first = true; at < pattern.size() && (first || pattern[at] != ']'); first = false) {
        if (pattern[at] == '\\' && at + 1 < pattern.size()) ++at;
        const char from = pattern[at++];
        char to = from;
        if (at + 1 < pattern.size() && pattern[at] == '-' && pattern[at + 1] != ']') {
            to = pattern[at + 1];
            at += 2;
        }
        const auto code = [](char letter) { return static_cast<unsigned char>(letter); };
        found = found || (code(from) <= code(c) && code(c) <= code(to));
    }
    if (at >= pattern.size()) return {};
    return {found != negated, at + 1};
}

// Matches one part of a path. From place `fold` on, the case of literal letters does not matter.
bool match_part(std::string_view pattern, std::string_view name, std::size_t fold) {
    if (name.starts_with('.') && !pattern.starts_with('.') && !pattern.starts_with("\\.")) return false;
    constexpr std::size_t kNone = std::string_view::npos;
    std::size_t p = 0, n = 0, star = kNone, star_name = 0;
    while (n < name.size()) {
        std::size_t next = kNone;  // the place in the pattern after a match of name[n]
        if (p < pattern.size()) {
            const char c = pattern[p];
            if (c == '*') {
                star = p++;
                star_name = n;
                continue;
            }
            if (c == '?') {
                next = p + 1;
            } else if (c == '[') {
                const ClassMatch found = match_class(pattern, p + 1, name[n]);
                if (found.matches) next = found.end;
            } else {
                const std::size_t literal = c == '\\' && p + 1 < pattern.size() ? p + 1 : p;
                const bool same =
                    literal >= fold ? lower(pattern[literal]) == lower(name[n]) : pattern[literal] == name[n];
                if (same) next = literal + 1;
            }
        }
        if (next != kNone) {
            p = next;
            ++n;
        } else if (star != kNone) {
            p = star + 1;
            n = ++star_name;
        } else {
            return false;
        }
    }
    while (p < pattern.size() && pattern[p] == '*') ++p;
    return p == pattern.size();
}

std::size_t fold_of(std::string_view part) {
    const std::size_t dot = part.rfind('.');
    return dot == std::string_view::npos ? part.size() : dot;
}

bool match_parts(const std::vector<std::string>& pattern, std::size_t p, const std::vector<std::string>& path,
                 std::size_t n) {
    for (; p < pattern.size(); ++p, ++n) {
        if (pattern[p] == "**") {
            for (std::size_t k = n; k < path.size(); ++k) {
                if (match_parts(pattern, p + 1, path, k)) return true;
                if (path[k].starts_with('.')) return false;
            }
            return false;
        }
        const std::size_t fold = p + 1 == pattern.size() ? fold_of(pattern[p]) : pattern[p].size();
        if (n == path.size() || !match_part(pattern[p], path[n], fold)) return false;
    }
    return n == path.size();
}

bool is_hidden(const std::string& part) { return part.starts_with('.'); }

bool reach_parts(const std::vector<std::string>& pattern, const std::vector<std::string>& folder) {
    for (std::size_t k = 0; k < folder.size(); ++k) {
        if (k + 1 >= pattern.size()) return false;
        const auto place = static_cast<std::ptrdiff_t>(k);
        if (pattern[k] == "**") {
            return std::none_of(folder.begin() + place, folder.end(), is_hidden) ||
                   std::any_of(pattern.begin() + place, pattern.end(), is_hidden);
        }
        if (!match_part(pattern[k], folder[k], pattern[k].size())) return false;
    }
    return true;
}

void check_brackets(const std::string& text, const std::string& part) {
    for (std::size_t k = 0; k < part.size(); ++k) {
        if (part[k] == '\\') {
            ++k;
        } else if (part[k] == '[') {
            const ClassMatch found = match_class(part, k + 1, '\0');
            if (found.end == std::string_view::npos)
                throw UsageError(fmt::format("'{}' has a [ without its ]", shown(text)));
            k = found.end - 1;
        }
    }
}

}  // namespace

Glob::Glob(std::string_view text) : text_(text) {
    if (text.empty()) throw UsageError("a pattern is empty");
    if (text.find('\0') != std::string_view::npos) throw UsageError("a pattern holds a NUL character");
    if (text.size() > kMostOfPattern)
        throw UsageError(fmt::format("'{}' has more than {} bytes", shown(text), kMostOfPattern));
    for (const std::string& one : without_braces(text_)) {
        if (is_absolute(one)) {
            throw UsageError(fmt::format("'{}' begins with /; patterns are relative to the root", shown(text)));
        }
        Parts parts;
        for (std::string& part : split(one, '/')) {
            if (part.empty() || part == ".") continue;
            if (part == "..") throw UsageError(fmt::format("'{}' leads out of the root by ..", shown(text)));
            check_brackets(text_, part);
            if (part == "**" && !parts.empty() && parts.back() == "**") continue;
            parts.push_back(std::move(part));
        }
        if (parts.empty()) throw UsageError(fmt::format("'{}' names no file", shown(text)));
        if (parts.back() == "**") parts.emplace_back("*");
        constexpr std::size_t kMostDeep = 4;  // matching tries all divisions of a path
        if (std::count(parts.begin(), parts.end(), "**") > static_cast<std::ptrdiff_t>(kMostDeep)) {
            throw UsageError(fmt::format("'{}' has more than {} parts **", shown(text), kMostDeep));
        }
        alternatives_.push_back(std::move(parts));
    }
}

bool Glob::matches(std::string_view path) const {
    const std::vector<std::string> parts = split(path, '/');
    return std::any_of(alternatives_.begin(), alternatives_.end(),
                       [&](const Parts& pattern) { return match_parts(pattern, 0, parts, 0); });
}

bool Glob::reaches(std::string_view folder) const {
    if (folder.empty()) return true;
    folder.remove_suffix(1);
    const std::vector<std::string> parts = split(folder, '/');
    return std::any_of(alternatives_.begin(), alternatives_.end(),
                       [&](const Parts& pattern) { return reach_parts(pattern, parts); });
}

}  // namespace tex::cli
