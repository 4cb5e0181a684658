// SPDX-License-Identifier: Apache-2.0

#include "build/cache.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <tuple>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include "batch/text_file.h"
#include "files/system_error.h"

namespace tex::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kHead = "libtex-cache 1 ";
constexpr std::size_t kHeadBytes = kHead.size() + 64 + 1;

}  // namespace

std::string Cache::entry(const Digest& key) const {
    const std::string name = key.hex();
    return folder_ + "/" + name.substr(0, 2) + "/" + name;
}

Result<bool> Cache::fetch(const Digest& key, const std::string& path, const WriteOptions& write) {
    const std::string from = entry(key);
    const auto text = read_text_file(from);
    if (!text) return false;
    const std::string_view body = std::string_view(*text).substr(std::min(kHeadBytes, text->size()));
    if (!text->starts_with(kHead) || text->size() < kHeadBytes || (*text)[kHeadBytes - 1] != '\n' ||
        std::string_view(*text).substr(kHead.size(), 64) != digest_of(body).hex()) {
        ++damaged_;
        return false;
    }
    // The time of the last use, for shrink(). It does not matter if this fails.
    std::ignore = utimensat(AT_FDCWD, from.c_str(), nullptr, 0);
    if (const auto written = write_text_file(path, std::string(body), write); !written) return written.error();
    return true;
}

Result<void> Cache::store(const Digest& key, const std::string& path) {
    const auto body = read_text_file(path);
    if (!body) return body.error();
    const std::string to = entry(key);
    std::error_code error;
    fs::create_directories(fs::path(to).parent_path(), error);
    if (error) return Error{ErrorCode::io, to, system_reason(error.value())};
    WriteOptions write;
    write.sync = false;  // a damaged entry is found when it is read
    return write_text_file(to, std::string(kHead) + digest_of(*body).hex() + "\n" + *body, write);
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
