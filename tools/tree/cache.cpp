// SPDX-License-Identifier: Apache-2.0

#include "tree/cache.h"

#include <algorithm>
#include <charconv>
#include <new>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "cli/text_file.h"
#include "tasks/name_pattern.h"
#include "tree/cache_folder.h"
#include "tree/state.h"

namespace tex::cli {
namespace {

std::string cache_head() { return fmt::format("libtex-cache {} ", kCacheVersion); }

// The first line of the entry `key`, whose bytes are `body`.
std::string first_line(const Digest& key, std::string_view body) {
    return fmt::format("{}{} {} {}\n", cache_head(), key.hex(), digest_of(body).hex(), body.size());
}

// Whether a file that begins so and has this size can be the entry `key`: its first line is one, and says the size.
bool can_be_entry(const Digest& key, std::string_view begin, std::int64_t size) {
    const std::string_view line = begin.substr(0, std::min(begin.find('\n'), begin.size() - 1) + 1);
    const std::string head = cache_head() + key.hex() + " ";
    constexpr std::size_t kSum = 64 + 1;
    if (!line.ends_with('\n') || !line.starts_with(head) || line.size() <= head.size() + kSum) return false;
    return line.substr(head.size() + kSum) == fmt::format("{}\n", size - static_cast<std::int64_t>(line.size()));
}

// If an output has several files, there is an entry for each of them, and one with their number.
bool has_parts(const OutputFiles& output) { return !output.levels.empty() || output.files.size() != 1; }
Digest key_of_part(const Digest& key, const std::string& part) {
    return Sha256().add(key.bytes.data(), key.bytes.size()).add(part).finish();
}
Digest warnings_key(const Digest& key) { return key_of_part(key, "warnings"); }
Digest count_key(const Digest& key) { return key_of_part(key, "levels"); }
Digest part_key(const Digest& key, std::size_t part) { return key_of_part(key, std::to_string(part)); }

constexpr std::size_t kMostParts = 100'000;

std::size_t part_count(const std::string& entry) {
    std::size_t count = 0;
    const auto [end, error] = std::from_chars(entry.data(), entry.data() + entry.size(), count);
    return error == std::errc() && end == entry.data() + entry.size() && count <= kMostParts ? count : 0;
}

}  // namespace

Result<void> Cache::open(bool is_read_only) const {
    return is_used() ? open_cache_folder(folder_, is_read_only) : Result<void>();
}

// The bytes of an entry that is there and undamaged.
std::optional<std::string> Cache::read(const Digest& key) {
    std::optional<std::string> text;
    try {
        text = read_cache_entry(folder_, key.hex(), [&](std::string_view begin, std::int64_t size) {
            return size <= most_ && can_be_entry(key, begin, size);
        });
    } catch (const std::bad_alloc&) {
        text = std::string();
    }
    if (!text) return std::nullopt;
    const std::size_t newline = text->find('\n'), end = newline == std::string::npos ? text->size() : newline + 1;
    const std::string_view line = std::string_view(*text).substr(0, end), body = std::string_view(*text).substr(end);
    if (line != first_line(key, body)) {
        ++damaged_;
        return std::nullopt;
    }
    text->erase(0, end);
    return std::move(*text);
}

Result<void> Cache::write(const Digest& key, const std::string& bytes) const {
    return write_cache_entry(folder_, key.hex(), first_line(key, bytes) + bytes);
}

Result<std::vector<std::string>> Cache::fetch(const Digest& key, const OutputFiles& output, const WriteOptions& write) {
    std::size_t count = 1;
    if (has_parts(output)) count = part_count(read(count_key(key)).value_or(""));
    const std::size_t others = output.files.size(), names = output.levels.size();
    const std::size_t levels = names > 0 && count > others ? (count - others) / names : 0;
    if (count != others + names * levels || (names > 0 && levels == 0)) return std::vector<std::string>();
    std::vector<std::string> files, contents;
    for (std::size_t k = 0; k < count; ++k) {
        std::optional<std::string> bytes = read(has_parts(output) ? part_key(key, k) : key);
        if (!bytes) return std::vector<std::string>();
        contents.push_back(std::move(*bytes));
        files.push_back(k < names * levels ? with_level(output.levels[k / levels], static_cast<int>(k % levels))
                                           : output.files[k - names * levels]);
    }
    for (std::size_t k = 0; k < count; ++k) {
        if (const auto written = write_text_file(files[k], contents[k], write); !written) return written.error();
    }
    return files;
}

std::vector<FileWarning> Cache::warnings(const Digest& key) {
    return parse_warnings(read(warnings_key(key)).value_or(""));
}

// The warnings first: whoever finds the output must find them, too.
Result<void> Cache::store(const Digest& key, const OutputFiles& output, const std::vector<std::string>& contents,
                          const std::vector<FileWarning>& warnings) const {
    if (!warnings.empty()) {
        if (auto written = write(warnings_key(key), warnings_text(warnings)); !written) return written;
    }
    for (std::size_t k = 0; k < contents.size(); ++k) {
        if (auto written = write(has_parts(output) ? part_key(key, k) : key, contents[k]); !written) return written;
    }
    return has_parts(output) ? write(count_key(key), std::to_string(contents.size())) : Result<void>();
}

void Cache::shrink(std::int64_t bytes, Console& console) const {
    std::vector<CacheEntry> entries;
    std::int64_t total = 0;
    const auto listed = list_cache_entries(folder_, cache_head(), [&](CacheEntry entry) {
        total += entry.size;
        entries.push_back(std::move(entry));
    });
    if (!listed) console.warning(listed.error().message());
    std::sort(entries.begin(), entries.end(), [](const CacheEntry& a, const CacheEntry& b) { return a.used < b.used; });
    for (const CacheEntry& oldest : entries) {
        if (total <= bytes) break;
        // Another process may have removed it.
        if (remove_cache_entry(folder_, oldest.name, cache_head())) total -= oldest.size;
    }
}

}  // namespace tex::cli
