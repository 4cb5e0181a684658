// SPDX-License-Identifier: Apache-2.0
// cache.h: a folder of outputs, named by what they are made from. Many machines may share it.
//
//     DIR/3f/3f92...   a line "libtex-cache 1 SHA-256", then the bytes that have this sum
//
// An entry is written under another name and renamed, so it is whole or absent, and two writers of one entry write the
// same bytes. An entry that is damaged all the same is found when it is read, and is made again.

#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tex/container.h>
#include <tex/result.h>

#include "cli/console.h"
#include "tree/sha256.h"

namespace tex::cli {

// Any thread may call any of these functions.
class Cache {
public:
    // An empty `folder` is no cache.
    explicit Cache(std::string folder) : folder_(std::move(folder)) {}

    [[nodiscard]] bool is_used() const { return !folder_.empty(); }

    // Writes the output `key` to the file `output`, or to a file for each level if the name contains {level}. Returns
    // the files; none if there is no such entry, or if it is damaged. Errors: those of writing.
    [[nodiscard]] Result<std::vector<std::string>> fetch(const Digest& key, const std::string& output,
                                                         const WriteOptions& write);
    // Keeps the files of an output, which are those that fetch() returns. Errors: io.
    [[nodiscard]] Result<void> store(const Digest& key, const std::string& output,
                                     const std::vector<std::string>& files);
    // Removes the entries that have not been used for the longest time until the others take at most `bytes`.
    void shrink(std::int64_t bytes, Console& console) const;

    [[nodiscard]] std::size_t damaged() const { return damaged_; }  // entries that fetch() has met

private:
    [[nodiscard]] std::string entry(const Digest& key) const;
    [[nodiscard]] std::optional<std::string> read(const Digest& key);
    [[nodiscard]] Result<void> write(const Digest& key, const std::string& bytes) const;

    const std::string folder_;
    std::atomic<std::size_t> damaged_{0};
};

}  // namespace tex::cli
