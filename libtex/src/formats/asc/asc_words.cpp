// SPDX-License-Identifier: Apache-2.0

#include "formats/asc/asc_words.h"

#include "formats/words.h"

namespace tex::inline v1 {
namespace {

constexpr std::size_t kLongestWord = 400;  // "%f" of the largest double has 317 characters
constexpr std::size_t kShownLength = 24;
constexpr std::size_t kPieceBytes = std::size_t{1} << 16;
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

}  // namespace

Result<int> WordReader::byte() {
    if (at_ == held_) {
        piece_.resize(kPieceBytes);
        const Result<std::size_t> got = file_.read_at(offset_, piece_.data(), piece_.size());
        if (!got) return got.error();
        offset_ += static_cast<std::int64_t>(*got);
        at_ = 0;
        held_ = *got;
        if (held_ == 0) return -1;
    }
    return std::to_integer<int>(piece_[at_++]);
}

Result<std::string_view> WordReader::next() {
    if (is_back_) {
        is_back_ = false;
        return std::string_view(word_);
    }
    word_.clear();
    line_ = next_line_;
    while (true) {
        const Result<int> got = byte();
        if (!got) return got.error();
        if (*got < 0) break;
        const char c = static_cast<char>(*got);
        if (c == '\n') ++next_line_;
        if (!is_blank(c)) {
            if (word_.size() == kLongestWord) return error("a word of more than 400 characters");
            word_ += c;
        } else if (!word_.empty()) {
            break;
        } else {
            line_ = next_line_;
        }
        if (line_ == 1 && word_ == kByteOrderMark) word_.clear();
    }
    return std::string_view(word_);
}

Error WordReader::error(const std::string& reason) const {
    return {ErrorCode::bad_data, file_.path(), "line " + std::to_string(line_) + ": " + reason};
}

std::string WordReader::shown() const {
    std::string text = "\"";
    for (const char c : word_.substr(0, kShownLength)) text += c >= ' ' && c <= '~' ? c : '?';
    return text + (word_.size() > kShownLength ? "...\"" : "\"");
}

}  // namespace tex::inline v1
