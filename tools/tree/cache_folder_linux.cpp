// SPDX-License-Identifier: Apache-2.0

#include "tree/cache_folder.h"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <memory>
#include <string_view>
#include <system_error>
#include <tuple>

#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <tex/file.h>
#include <unistd.h>

#include "cli/text.h"
#include "cli/text_file.h"
#include "cli/usage_error.h"
#include "files/path_names.h"
#include "files/system_error.h"
#include "options/files.h"
#include "tasks/folders.h"
#include "tree/opened_linux.h"

namespace tex::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMark = "libtex-cache";
constexpr const char* kTag = "CACHEDIR.TAG";
constexpr std::string_view kTagText =
    "Signature: 8a477f597d28d172789f06886806bc55\n"
    "# This folder is a cache of build-normals. Everything in it can be made again.\n"
    "# For information about cache directory tags see https://bford.info/cachedir/\n";

std::string mark_text() { return fmt::format("{} {}\n", kMark, kCacheVersion); }

constexpr int kFolderFlags = O_RDONLY | O_DIRECTORY | O_CLOEXEC;

// The folder of entries whose names begin with the same two digits.
Opened open_shelf(int cache, const std::string& name) {
    return Opened(openat(cache, name.substr(0, 2).c_str(), kFolderFlags | O_NOFOLLOW));
}

// Opens a regular file; its status is returned in `status`.
Opened open_entry(int shelf, const std::string& name, struct stat& status) {
    // O_NONBLOCK: a FIFO must not keep us waiting.
    const int fd = openat(shelf, name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (fd >= 0 && fstat(fd, &status) == 0 && S_ISREG(status.st_mode)) return Opened(fd);
    if (fd >= 0) close(fd);
    return Opened(-1);
}

bool begins_with(int fd, const std::string& head) {
    std::string text(head.size(), '\0');
    return pread(fd, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size()) && text == head;
}

// The text of a regular file; nothing if it cannot be read.
std::optional<std::string> read_all(int fd, std::int64_t size) {
    std::string text(static_cast<std::size_t>(size), '\0');
    std::size_t at = 0;
    while (at < text.size()) {
        const ssize_t count = pread(fd, text.data() + at, text.size() - at, static_cast<off_t>(at));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return std::nullopt;
        at += static_cast<std::size_t>(count);
    }
    return text;
}

// Calls `seen` with each name in the open folder, except "." and "..". Returns 0 or an errno.
int list_folder(int fd, const std::function<void(const std::string&)>& seen) {
    const int copy = openat(fd, ".", kFolderFlags);
    const std::unique_ptr<DIR, int (*)(DIR*)> dir(copy < 0 ? nullptr : fdopendir(copy),
                                                  [](DIR* open) { return open == nullptr ? 0 : closedir(open); });
    if (!dir) return errno;
    errno = 0;
    while (const dirent* entry = readdir(dir.get())) {
        const std::string name = entry->d_name;
        if (name != "." && name != "..") seen(name);
        errno = 0;
    }
    return errno;
}

bool is_hex(std::string_view text) {
    return std::all_of(text.begin(), text.end(),
                       [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
}

// A file through the folder that is open: no other program can make a link of a part of this path.
std::string path_in(int folder, const std::string& name) { return fmt::format("/proc/self/fd/{}/{}", folder, name); }

// `folder` is its name in messages.
Result<void> write_in(int fd, const std::string& folder, const std::string& name, const std::string& text) {
    WriteOptions options;
    options.sync = false;  // a damaged entry is found when it is read
    options.follow_links = false;
    const Result<void> written = write_text_file(path_in(fd, name), text, options);
    return written ? written
                   : Error{written.error().code, folder + "/" + name, written.error().reason, written.error().detail};
}

// Whether the folder holds nothing but the marks that another process is making now.
bool is_empty(int fd) {
    const auto is_mark = [](const std::string& name) {
        const auto is_of = [&](const std::string& mark) {
            return name == mark || name.starts_with("." + mark + ".tex-tmp");
        };
        return is_of(kMark) || is_of(kTag);
    };
    bool is_empty = true;
    std::ignore = list_folder(fd, [&](const std::string& name) { is_empty = is_empty && is_mark(name); });
    return is_empty;
}

}  // namespace

Result<void> open_cache_folder(const std::string& folder, bool is_read_only) {
    std::error_code error;
    if (!fs::exists(folder, error)) {
        if (is_read_only) return {};
        if (auto created = create_folders_of(slashed(fs::path(folder) / "")); !created) return created;
    }
    const Opened cache(open(folder.c_str(), kFolderFlags));
    if (!cache) return Error{ErrorCode::io, folder, system_reason(errno)};
    struct stat status {};
    if (const Opened mark = open_entry(cache.get(), kMark, status); mark) {
        if (begins_with(mark.get(), mark_text())) return {};
        throw UsageError(fmt::format("--cache {}: is a cache of another version; name another folder, or remove it",
                                     printable(folder)));
    }
    if (!is_empty(cache.get())) {
        throw UsageError(
            fmt::format("--cache {}: holds other files and is not a cache of build-normals; name an "
                        "empty folder or a new one",
                        printable(folder)));
    }
    if (is_read_only) return {};
    if (auto marked = write_in(cache.get(), folder, kMark, mark_text()); !marked) return marked;
    return write_in(cache.get(), folder, kTag, std::string(kTagText));
}

std::optional<std::string> read_cache_entry(
    const std::string& folder, const std::string& name,
    const std::function<bool(std::string_view begin, std::int64_t size)>& accepts) {
    const Opened cache(open(folder.c_str(), kFolderFlags));
    const Opened shelf = open_shelf(cache.get(), name);
    struct stat status {};
    if (!shelf || fstatat(shelf.get(), name.c_str(), &status, AT_SYMLINK_NOFOLLOW) != 0) return std::nullopt;
    const Opened file = open_entry(shelf.get(), name, status);
    if (!file) return std::string();
    const std::int64_t size = status.st_size;
    const auto begin = read_all(file.get(), std::min(size, static_cast<std::int64_t>(kMostOfHead)));
    if (!begin || begin->empty() || !accepts(*begin, size)) return std::string();
    // The time of the last use, by which entries are removed. It does not matter if this fails.
    std::ignore = futimens(file.get(), nullptr);
    return read_all(file.get(), size).value_or(std::string());
}

Result<void> write_cache_entry(const std::string& folder, const std::string& name, const std::string& text) {
    const Opened cache(open(folder.c_str(), kFolderFlags));
    if (!cache) return Error{ErrorCode::io, folder, system_reason(errno)};
    const std::string first = name.substr(0, 2);
    std::ignore = mkdirat(cache.get(), first.c_str(), 0777);
    const Opened shelf = open_shelf(cache.get(), name);
    if (!shelf) return Error{ErrorCode::io, folder + "/" + first, system_reason(errno)};
    return write_in(shelf.get(), folder + "/" + first, name, text);
}

Result<void> list_cache_entries(const std::string& folder, const std::string& head,
                                const std::function<void(CacheEntry)>& found) {
    const Opened cache(open(folder.c_str(), kFolderFlags));
    if (!cache) return Error{ErrorCode::io, folder, system_reason(errno)};
    const int failed = list_folder(cache.get(), [&](const std::string& first) {
        if (first.size() != 2 || !is_hex(first)) return;
        const Opened shelf = open_shelf(cache.get(), first);
        if (!shelf) return;
        std::ignore = list_folder(shelf.get(), [&](const std::string& name) {
            if (name.size() != 64 || !is_hex(name) || !name.starts_with(first)) return;
            struct stat status {};
            const Opened file = open_entry(shelf.get(), name, status);
            if (!file || !begins_with(file.get(), head)) return;
            const timespec& time = status.st_mtim;
            found({name, std::int64_t{time.tv_sec} * 1000000000 + time.tv_nsec, status.st_size});
        });
    });
    return failed == 0 ? Result<void>() : Error{ErrorCode::io, folder, system_reason(failed)};
}

bool remove_cache_entry(const std::string& folder, const std::string& name, const std::string& head) {
    const Opened cache(open(folder.c_str(), kFolderFlags));
    const Opened shelf = open_shelf(cache.get(), name);
    struct stat status {};
    const Opened file = open_entry(shelf.get(), name, status);
    return file && begins_with(file.get(), head) && unlinkat(shelf.get(), name.c_str(), 0) == 0;
}

}  // namespace tex::cli
