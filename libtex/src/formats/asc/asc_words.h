// SPDX-License-Identifier: Apache-2.0
// asc_words.h: the words of a text file, one after the other.

#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <tex/types.h>

#include "files/input_file.h"

namespace tex::inline v1 {

class WordReader {
public:
    // The words of a file that must outlive this object, and whose size is known. A byte order mark of UTF-8 is no
    // word.
    explicit WordReader(const InputFile& file) : file_(file) {}

    // The next word, which stays until the next call; empty at the end of the file. Throws std::bad_alloc. Errors: io,
    // bad_data (a word longer than any number).
    Result<std::string_view> next();
    // next() gives the same word again.
    void put_back() { is_back_ = true; }
    // What is wrong with the last word, with the number of its line.
    [[nodiscard]] Error error(const std::string& reason) const;
    // The last word as a message shows it.
    [[nodiscard]] std::string shown() const;

private:
    // The next byte, or -1 at the end.
    Result<int> byte();

    const InputFile& file_;
    std::vector<std::byte> piece_;
    std::size_t at_ = 0, held_ = 0;
    std::int64_t offset_ = 0, line_ = 1, next_line_ = 1;
    std::string word_;
    bool is_back_ = false;
};

}  // namespace tex::inline v1
