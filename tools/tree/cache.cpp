// SPDX-License-Identifier: Apache-2.0

#include "tree/cache.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <system_error>
#include <tuple>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include "batch/name_pattern.h"
#include "cli/text_file.h"
#include "files/system_error.h"
#include "options/files.h"

namespace tex::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kCacheHead = "libtex-cache 1 ";
constexpr std::size_t kCacheHeadBytes = kCacheHead.size() + 64 + 1;

// If each level has its file, there is an entry for each of them, and one with their number.
Digest key_of_part(const Digest& key, const std::string& part) {
    return Sha256().add(key.bytes.data(), key.bytes.size()).add(part).finish();
}
Digest count_key(const Digest& key) { return key_of_part(key, "levels"); }
Digest level_key(const Digest& key, std::size_t level) { return key_of_part(key, std::to_string(level)); }

std::size_t level_count(const std::string& entry) {
    std::size_t count = 0;
    const auto [end, error] = std::from_chars(entry.data(), entry.data() + entry.size(), count);
    return error == std::errc() && end == entry.data() + entry.size() && count <= 32 ? count : 0;
}

}  // namespace

std::string Cache::entry(const Digest& key) const {
    const std::string name = key.hex();
    return folder_ + "/" + name.substr(0, 2) + "/" + name;
}

// The bytes of an entry that is there and undamaged.
std::optional<std::string> Cache::read(const Digest& key) {
    const std::string from = entry(key);
    auto text = read_text_file(from);
    if (!text) return std::nullopt;
    const std::string_view body = std::string_view(*text).substr(std::min(kCacheHeadBytes, text->size()));
    if (!text->starts_with(kCacheHead) || text->size() < kCacheHeadBytes || (*text)[kCacheHeadBytes - 1] != '\n' ||
        std::string_view(*text).substr(kCacheHead.size(), 64) != digest_of(body).hex()) {
        ++damaged_;
        return std::nullopt;
    }
    // The time of the last use, for shrink(). It does not matter if this fails.
    std::ignore = utimensat(AT_FDCWD, from.c_str(), nullptr, 0);
    text->erase(0, kCacheHeadBytes);
    return std::move(*text);
}

Result<void> Cache::write(const Digest& key, const std::string& bytes) const {
    const std::string to = entry(key);
    if (auto created = create_folders_of(to); !created) return created;
    WriteOptions options;
    options.sync = false;  // a damaged entry is found when it is read
    return write_text_file(to, std::string(kCacheHead) + digest_of(bytes).hex() + "\n" + bytes, options);
}

Result<std::vector<std::string>> Cache::fetch(const Digest& key, const std::string& output, const WriteOptions& write) {
    const bool has_levels = has_level(output);
    std::size_t count = 1;
    if (has_levels) count = level_count(read(count_key(key)).value_or(""));
    std::vector<std::string> files, contents;
    for (std::size_t k = 0; k < count; ++k) {
        std::optional<std::string> bytes = read(has_levels ? level_key(key, k) : key);
        if (!bytes) return std::vector<std::string>();
        contents.push_back(std::move(*bytes));
        files.push_back(has_levels ? with_level(output, static_cast<int>(k)) : output);
    }
    for (std::size_t k = 0; k < count; ++k) {
        if (const auto written = write_text_file(files[k], contents[k], write); !written) return written.error();
    }
    return files;
}

Result<void> Cache::store(const Digest& key, const std::string& output, const std::vector<std::string>& files) {
    const bool has_levels = has_level(output);
    for (std::size_t k = 0; k < files.size(); ++k) {
        const auto bytes = read_text_file(files[k]);
        if (!bytes) return bytes.error();
        if (auto written = write(has_levels ? level_key(key, k) : key, *bytes); !written) return written;
    }
    return has_levels ? write(count_key(key), std::to_string(files.size())) : Result<void>();
}

void Cache::shrink(std::int64_t bytes, Console& console) const {
    struct Entry {
        std::int64_t used;
        std::int64_t size;
        std::string path;
    };
    std::vector<Entry> entries;
    std::int64_t total = 0;
    std::error_code error;
    for (fs::recursive_directory_iterator at(folder_, error), end; !error && at != end; at.increment(error)) {
        struct stat status {};
        const std::string path = at->path().string();
        if (stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) continue;
        entries.push_back(
            {std::int64_t{status.st_mtim.tv_sec} * 1000000000 + status.st_mtim.tv_nsec, status.st_size, path});
        total += status.st_size;
    }
    if (error) console.warning(fmt::format("{}: {}", folder_, system_reason(error.value())));
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.used < b.used; });
    for (const Entry& oldest : entries) {
        if (total <= bytes) break;
        std::error_code ignored;  // another process may have removed it
        if (fs::remove(oldest.path, ignored)) total -= oldest.size;
    }
}

}  // namespace tex::cli
