// SPDX-License-Identifier: Apache-2.0
// file_table.h: files by what they are, whatever they are called.
//
// Two names belong to one file if they lead to one place, through links or by other spellings ("art/../art/a.png"), or
// if they are hard links to one file. A file that does not exist yet is known by the nearest folder that does, and by
// the rest of its name.

#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/file_status.h"

namespace tex::cli {

// A file or, if `rest` is not empty, a place in a folder.
struct FileKey {
    std::uint64_t device = 0, inode = 0;
    std::string rest = {};

    friend auto operator<=>(const FileKey&, const FileKey&) = default;
};

// The place of a name. Links on the way are followed; the last component is not.
[[nodiscard]] FileKey place_of_file(const std::string& path);

// Every key by which `path` can be recognised: its place, the place that it leads to as a link, and the regular file
// there. "-" is the file behind the descriptor `standard`; it has no place.
[[nodiscard]] std::vector<FileKey> keys_of_file(const std::string& path, int standard);

template <class T>
class FileTable {
public:
    // Adds a file by all of its keys. Returns what is known about it already; null if it is new.
    const T* add(const std::string& path, T value, int standard = kStandardInput) {
        return add_keys(keys_of_file(path, standard), std::move(value));
    }
    // Finds it by the place alone: for files that are replaced there, whatever their names lead to now.
    const T* add_place(const std::string& path, T value) { return add_keys({place_of_file(path)}, std::move(value)); }
    // What is known about a file; null if nothing is.
    [[nodiscard]] const T* find(const std::string& path, int standard = kStandardOutput) const {
        for (const FileKey& key : keys_of_file(path, standard)) {
            if (const auto found = known_.find(key); found != known_.end()) return &found->second;
        }
        return nullptr;
    }

private:
    const T* add_keys(const std::vector<FileKey>& keys, const T& value) {
        const T* earlier = nullptr;
        for (const FileKey& key : keys) {
            const auto [found, is_new] = known_.emplace(key, value);
            if (!is_new && earlier == nullptr) earlier = &found->second;
        }
        return earlier;
    }

    std::map<FileKey, T> known_;
};

}  // namespace tex::cli
