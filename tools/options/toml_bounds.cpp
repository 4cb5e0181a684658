// SPDX-License-Identifier: Apache-2.0

#include "options/toml_bounds.h"

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cli/text.h"
#include "cli/text_file.h"
#include "cli/usage_error.h"

namespace tex::cli {
namespace {

// Scans the text once. The parser stops at the first place that is not TOML, so the result for the text after it does
// not matter.
class Scanner {
public:
    // `outside` is called with each place outside strings and comments; it may be empty.
    explicit Scanner(std::string_view text, std::function<void(std::size_t at)> outside = {})
        : text_(text), outside_(std::move(outside)) {}

    // The line (from 1) of the first statement that nests too deeply; 0 if there is none.
    int line_of_excess() {
        while (at_ < text_.size()) {
            const char c = text_[at_];
            if (c == '"' || c == '\'') {
                skip_string(c);
            } else if (c == '#') {
                at_ = std::min(text_.find('\n', at_), text_.size());
            } else {
                if (outside_) outside_(at_);
                ++at_;
                count(c);
            }
            if (levels_ > kMostTomlLevels) return line_;
        }
        return 0;
    }

private:
    void count(char c) {
        if (c == '\n') ++line_;
        if (c == '[' || c == '{') {
            outer_.push_back(levels_);
            ++levels_;
        } else if ((c == ']' || c == '}') && !outer_.empty()) {
            levels_ = outer_.back();
            outer_.pop_back();
        } else if (c == '.') {
            ++levels_;
        } else if (c == ',' || c == '\n') {  // the next element or statement
            levels_ = outer_.empty() ? 0 : outer_.back() + 1;
        }
    }

    [[nodiscard]] std::size_t quotes_at(std::size_t at, char quote) const {
        return std::min(text_.find_first_not_of(quote, at), text_.size()) - at;
    }

    void skip_string(char quote) {
        constexpr std::size_t kLong = 3;
        const std::size_t begin = quotes_at(at_, quote);
        if (begin == 2) {  // an empty string
            at_ += 2;
            return;
        }
        const bool is_long = begin >= kLong;
        at_ += is_long ? kLong : 1;
        while (at_ < text_.size()) {
            const char c = text_[at_];
            if (c == quote) {
                if (!is_long) {
                    ++at_;
                    return;
                }
                // The last one or two characters of the string may be quotes.
                const std::size_t quotes = quotes_at(at_, quote);
                at_ += std::min(quotes, kLong + 2);
                if (quotes >= kLong) return;
                continue;
            }
            if (c == '\n' && !is_long) return;
            if (c == '\n') ++line_;
            at_ += c == '\\' && quote == '"' ? 2 : 1;
            if (c == '\\' && quote == '"' && at_ <= text_.size() && text_[at_ - 1] == '\n') ++line_;
        }
    }

    std::string_view text_;
    std::function<void(std::size_t)> outside_;
    std::size_t at_ = 0;
    int line_ = 1;
    int levels_ = 0;          // around the text at at_
    std::vector<int> outer_;  // around each open bracket
};

}  // namespace

Result<std::string> read_toml_file(const std::string& path) {
    auto text = read_text_file(path, kMostTomlBytes);
    if (!text && text.error().code == ErrorCode::bad_data) throw UsageError(text.error().message());
    return text;
}

void check_toml_bounds(const std::string& path, std::string_view text) {
    if (text.size() > kMostTomlBytes) {
        throw UsageError(fmt::format("{}: {} bytes; a file of settings has at most {}", printable(path), text.size(),
                                     kMostTomlBytes));
    }
    if (const int line = Scanner(text).line_of_excess(); line > 0) {
        throw UsageError(fmt::format("{}: line {}: keys and lists nest deeper than {} levels", printable(path), line,
                                     kMostTomlLevels));
    }
}

std::string ascii_outside_strings(std::string_view text) {
    std::string ascii(text.substr(text.starts_with("\xef\xbb\xbf") ? 3 : 0));
    const std::string_view scanned = ascii;
    std::vector<std::size_t> foreign;
    Scanner(scanned, [&](std::size_t at) {
        if (static_cast<unsigned char>(scanned[at]) > 0x7e) foreign.push_back(at);
    }).line_of_excess();
    for (const std::size_t at : foreign) ascii[at] = '?';
    return ascii;
}

}  // namespace tex::cli
