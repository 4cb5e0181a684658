// SPDX-License-Identifier: Apache-2.0
// cache_folder.h: the files of a cache. No function here follows a link below the folder of the cache.

#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include <tex/types.h>

namespace tex::cli {

inline constexpr int kCacheVersion = 3;

// Makes a missing or empty folder a cache, unless `is_read_only` is set, and checks that any other one is a cache.
// Throws UsageError; see Cache::open(). Errors: io.
[[nodiscard]] Result<void> open_cache_folder(const std::string& folder, bool is_read_only);

// The longest first line of an entry.
inline constexpr std::size_t kMostOfHead = 256;

// Reads the entry `name` and sets its time of use. `accepts` sees the begin of the entry, up to kMostOfHead bytes, and
// its size; the rest is read only if it returns true. Nothing if there is no file of this name; an empty text if it is
// something else than a regular file, cannot be read or is not accepted. May throw std::bad_alloc.
[[nodiscard]] std::optional<std::string> read_cache_entry(
    const std::string& folder, const std::string& name,
    const std::function<bool(std::string_view begin, std::int64_t size)>& accepts);

// Writes the entry `name`, and replaces what has its name. Errors: io.
[[nodiscard]] Result<void> write_cache_entry(const std::string& folder, const std::string& name,
                                             const std::string& text);

struct CacheEntry {
    std::string name;
    std::int64_t used = 0;  // when, in nanoseconds
    std::int64_t size = 0;  // in bytes
};

// Calls `found` with every file that has the name of an entry and begins with `head`. Errors: io.
[[nodiscard]] Result<void> list_cache_entries(const std::string& folder, const std::string& head,
                                              const std::function<void(CacheEntry)>& found);

// Removes an entry that list_cache_entries() has found. Returns whether it is gone.
bool remove_cache_entry(const std::string& folder, const std::string& name, const std::string& head);

}  // namespace tex::cli
