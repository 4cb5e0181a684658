// SPDX-License-Identifier: Apache-2.0
// cache.h: a folder of outputs, named by what they are made from. Many machines may share it.
//
//     DIR/CACHEDIR.TAG    the mark by which backup programs know a cache (bford.info/cachedir)
//     DIR/libtex-cache    "libtex-cache 3": the version of this layout
//     DIR/3f/3f92...      an entry: a line "libtex-cache 3 KEY SHA-256 SIZE", then so many bytes, which have this sum
//
// Whoever may write to a shared cache is not trusted with more than its entries: no link below DIR is followed, an
// entry is a regular file that names its own key and has the size that it says, and one that is damaged, or larger than
// the memory that the run may take, is replaced by a rename. No more than the first line of such an entry is read. Only
// entries are ever removed. An entry is written under another name and renamed, so it is whole or absent, and two
// writers of one entry write the same bytes.

#pragma once

#include <atomic>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tex/file.h>
#include <tex/types.h>

#include "cli/console.h"
#include "cli/json.h"
#include "tree/recipe.h"
#include "tree/sha256.h"

namespace tex::cli {

// Any thread may call any of these functions.
class Cache {
public:
    // An empty `folder` is no cache. Entries of more than `most` bytes are not read.
    explicit Cache(std::string folder, std::int64_t most = std::numeric_limits<std::int64_t>::max())
        : folder_(std::move(folder)), most_(most) {}

    [[nodiscard]] bool is_used() const { return !folder_.empty(); }

    // To be called first. A folder that is missing or empty becomes a cache, unless `is_read_only` is set. Throws
    // UsageError: the folder holds other files and is not marked as a cache, or is one of another version. Errors: io.
    [[nodiscard]] Result<void> open(bool is_read_only) const;

    // Writes the output `key` to its files. Returns them, those of levels first; none if there is no such entry, or if
    // it is damaged. Errors: those of writing.
    [[nodiscard]] Result<std::vector<std::string>> fetch(const Digest& key, const OutputFiles& output,
                                                         const WriteOptions& write);
    // The warnings that making the output `key` called for, as store() was given them.
    [[nodiscard]] std::vector<FileWarning> warnings(const Digest& key);
    // Keeps the contents of the files that fetch() returns, and the warnings. Errors: io.
    [[nodiscard]] Result<void> store(const Digest& key, const OutputFiles& output,
                                     const std::vector<std::string>& contents,
                                     const std::vector<FileWarning>& warnings) const;
    // Removes the entries that have not been used for the longest time until the others take at most `bytes`.
    void shrink(std::int64_t bytes, Console& console) const;

    [[nodiscard]] std::size_t damaged() const { return damaged_; }  // entries that fetch() has met

private:
    [[nodiscard]] std::optional<std::string> read(const Digest& key);
    [[nodiscard]] Result<void> write(const Digest& key, const std::string& bytes) const;

    const std::string folder_;
    const std::int64_t most_;
    std::atomic<std::size_t> damaged_{0};
};

}  // namespace tex::cli
