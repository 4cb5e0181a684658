// SPDX-License-Identifier: Apache-2.0

#include "cli/text.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tex::cli {
namespace {

// Optimal string alignment distance (Damerau-Levenshtein without overlapping edits).
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t changed = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, changed});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                row[j] = std::min(row[j], before[j - 2] + 1);
            }
        }
        std::swap(before, last);
        std::swap(last, row);
    }
    return last[b.size()];
}

// Characters that are invisible themselves but change the text around them: they reverse the direction of a line, so
// that a name reads backwards, they break the line, or they make two names look the same. (Joiners, U+200C and U+200D,
// are not included, because they are part of words.)
bool is_format_control(char32_t code) {
    constexpr std::pair<char32_t, char32_t> kRanges[] = {{0x61c, 0x61c},   {0x200b, 0x200b},  {0x200e, 0x200f},
                                                         {0x2028, 0x202e}, {0x2060, 0x206f},  {0xfeff, 0xfeff},
                                                         {0xfff9, 0xfffb}, {0xe0000, 0xe007f}};
    return std::any_of(std::begin(kRanges), std::end(kRanges),
                       [code](const auto& range) { return code >= range.first && code <= range.second; });
}

// The length in bytes of the UTF-8 character, in its shortest form, at the start of `text`; 0 if there is none or it is
// a control character.
std::size_t character_length(std::string_view text) {
    const auto byte = [&](std::size_t k) { return k < text.size() ? static_cast<unsigned char>(text[k]) : 0u; };
    const unsigned first = byte(0);
    if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
    const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
    if (first < 0xc2 || first > 0xf4) return 0;
    char32_t code = first & (0x7fu >> length);
    for (std::size_t k = 1; k < length; ++k) {
        if ((byte(k) & 0xc0) != 0x80) return 0;
        code = code << 6 | (byte(k) & 0x3f);
    }
    constexpr char32_t kLeast[] = {0, 0, 0xa0, 0x800,
                                   0x10000};  // those of two bytes start after the control characters
    const bool is_character = (code < 0xd800 || code >= 0xe000) && code != 0xfffe && code != 0xffff;
    return code >= kLeast[length] && code <= 0x10ffff && is_character && !is_format_control(code) ? length : 0;
}

// The length of what both names begin and end with, in whole pieces: "--mip-" of "--mip-filter" and "--mip-domain".
std::pair<std::size_t, std::size_t> same_pieces(std::string_view a, std::string_view b) {
    const std::size_t most = std::min(a.size(), b.size());
    std::size_t begin = 0, end = 0;
    for (std::size_t k = 0; k < most && a[k] == b[k]; ++k) begin = a[k] == '-' ? k + 1 : begin;
    for (std::size_t k = 0; k + begin < most && a[a.size() - 1 - k] == b[b.size() - 1 - k]; ++k)
        end = a[a.size() - 1 - k] == '-' ? k + 1 : end;
    return {begin, end};
}

// Whether one may be a slip for the other: "--y-ni", but not "--ao-out" for "--id-out". Pieces that both have say
// nothing about that.
bool is_slip(std::string_view a, std::string_view b, std::size_t distance) {
    const auto same = same_pieces(a, b);
    const std::size_t length = std::max(a.size(), b.size()) - same.first - same.second;
    return 3 * distance <= length || (distance == 1 && length == 2);
}

}  // namespace

std::string nearest(std::string_view word, const std::vector<std::string>& candidates) {
    std::string best;
    std::size_t best_distance = word.size() + 1;
    for (const std::string& candidate : candidates) {
        const std::size_t distance = edit_distance(word, candidate);
        if (distance < best_distance && is_slip(word, candidate, distance)) {
            best_distance = distance;
            best = candidate;
        }
    }
    if (!best.empty() || word.size() < 3) return best;
    for (const std::string& candidate : candidates) {
        if (candidate.starts_with(word)) return candidate;
    }
    return {};
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates) {
    const std::string name = nearest(word, candidates);
    return name.empty() ? std::string() : fmt::format("; did you mean {}?", name);
}

std::string lower_case(std::string text) {
    for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return text;
}

std::string join(const std::vector<std::string>& words, std::string_view between) {
    return fmt::format("{}", fmt::join(words, between));
}

std::vector<std::string> list_of(std::string_view text) {
    const char separator = text.find('\0') == std::string_view::npos ? '\n' : '\0';
    std::vector<std::string> entries;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find(separator), text.size());
        if (end > 0) entries.emplace_back(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return entries;
}

std::string printable(std::string_view text) {
    std::string safe;
    while (!text.empty()) {
        const std::size_t whole = character_length(text);
        const std::string_view bytes = text.substr(0, std::max<std::size_t>(whole, 1));
        if (whole > 0) {
            safe += bytes;
        } else {
            safe += fmt::format("\\x{:02x}", static_cast<unsigned char>(bytes.front()));
        }
        text.remove_prefix(bytes.size());
    }
    return safe;
}

std::string shell_word(const std::string& word) {
    constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./+@%,:=";
    if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
    const bool is_printable = printable(word) == word;
    std::string text = is_printable ? "'" : "$'";
    for (const char c : word) {
        if (c == '\'') {
            text += is_printable ? "'\\''" : "\\'";
        } else {
            text += c == '\\' && !is_printable ? std::string("\\\\") : std::string(1, c);
        }
    }
    return printable(text) + "'";
}

std::string shell_file(const std::string& name) {
    const bool is_argument = name.size() > 1 && (name.front() == '-' || name.front() == '@');
    return shell_word(is_argument ? "./" + name : name);
}

std::vector<std::string> wrapped(std::string_view text, std::size_t width) {
    std::vector<std::string> lines(1);
    while (!text.empty()) {
        const std::size_t end = std::min(text.find(' '), text.size());
        const std::string_view word = text.substr(0, end);
        std::string& line = lines.back();
        if (line.empty()) {
            line = word;
        } else if (line.size() + 1 + word.size() <= width) {
            line.append(" ").append(word);
        } else {
            lines.emplace_back(word);
        }
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return lines;
}

}  // namespace tex::cli
