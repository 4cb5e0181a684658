// SPDX-License-Identifier: Apache-2.0
// By paths, because not every system opens files relative to an open folder. Links are looked for before each step, so
// that whoever may write to the cache could still put one there in between.

#include "tree/cache_folder.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <tuple>

#include <fmt/format.h>
#include <tex/file.h>

#include "cli/file_status.h"
#include "cli/text.h"
#include "cli/text_file.h"
#include "cli/usage_error.h"
#include "files/path_names.h"
#include "files/system_error.h"
#include "tasks/folders.h"

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

bool is_folder_itself(const std::string& path) {
    const auto status = status_of_link(path);
    return status && status->kind == FileKind::folder;
}

// The folder of entries whose names begin with the same two digits; empty if there is none.
std::string shelf_of(const std::string& folder, const std::string& name) {
    std::string shelf = folder + "/" + name.substr(0, 2);
    return is_folder_itself(shelf) ? shelf : std::string();
}

// The text of a regular file; nothing if it is something else or cannot be read.
std::optional<std::string> text_of_entry(const std::string& path, FileStatus& status,
                                         std::size_t most = static_cast<std::size_t>(-1)) {
    const ReadFile file = open_at_once(path, Links::refused, status);
    if (!file || !status.is_regular()) return std::nullopt;
    std::string text(std::min(static_cast<std::size_t>(status.size), most), '\0');
    std::size_t at = 0;
    while (at < text.size()) {
        const auto count = read_from(file.get(), text.data() + at, text.size() - at);
        if (!count || *count == 0) return std::nullopt;
        at += *count;
    }
    return text;
}

bool begins_with(const std::string& path, const std::string& head, FileStatus& status) {
    return text_of_entry(path, status, head.size()) == head;
}

// Calls `seen` with each name in the folder. Returns 0 or an errno.
int list_folder(const std::string& folder, const std::function<void(const std::string&)>& seen) {
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
        seen(slashed(entry->path().filename()));
    return error.value();
}

bool is_hex(std::string_view text) {
    return std::all_of(text.begin(), text.end(),
                       [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
}

Result<void> write_in(const std::string& folder, const std::string& name, const std::string& text) {
    WriteOptions options;
    options.sync = false;  // a damaged entry is found when it is read
    options.follow_links = false;
    return write_text_file(folder + "/" + name, text, options);
}

// Whether the folder holds nothing but the marks that another process is making now.
bool is_empty(const std::string& folder) {
    bool is_empty = true;
    std::ignore = list_folder(folder, [&](const std::string& name) {
        const bool is_mark = name == kMark || name == kTag || name.starts_with(fmt::format(".{}.tex-tmp", kMark)) ||
                             name.starts_with(fmt::format(".{}.tex-tmp", kTag));
        is_empty = is_empty && is_mark;
    });
    return is_empty;
}

}  // namespace

Result<void> open_cache_folder(const std::string& folder, bool is_read_only) {
    if (!status_of(folder)) {
        if (is_read_only) return {};
        if (auto created = create_folders_of(slashed(fs::path(folder) / "")); !created) return created;
    }
    const auto opened = status_of(folder);
    if (!opened) return Error{ErrorCode::io, folder, system_reason(errno)};
    if (opened->kind != FileKind::folder) return Error{ErrorCode::io, folder, system_reason(ENOTDIR)};
    FileStatus status;
    if (const auto mark = text_of_entry(folder + "/" + kMark, status)) {
        if (mark->starts_with(mark_text())) return {};
        throw UsageError(fmt::format("--cache {}: is a cache of another version; name another folder, or remove it",
                                     printable(folder)));
    }
    if (!is_empty(folder)) {
        throw UsageError(
            fmt::format("--cache {}: holds other files and is not a cache of build-normals; name an "
                        "empty folder or a new one",
                        printable(folder)));
    }
    if (is_read_only) return {};
    if (auto marked = write_in(folder, kMark, mark_text()); !marked) return marked;
    return write_in(folder, kTag, std::string(kTagText));
}

std::optional<std::string> read_cache_entry(
    const std::string& folder, const std::string& name,
    const std::function<bool(std::string_view begin, std::int64_t size)>& accepts) {
    const std::string shelf = shelf_of(folder, name), path = shelf + "/" + name;
    if (shelf.empty() || !status_of_link(path)) return std::nullopt;
    FileStatus status;
    const auto begin = text_of_entry(path, status, kMostOfHead);
    if (!begin || begin->empty() || !accepts(*begin, status.size)) return std::string();
    const auto text = text_of_entry(path, status);
    if (!text) return std::string();
    // The time of the last use, by which entries are removed. It does not matter if this fails.
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    std::ignore = set_mtime(path, std::chrono::duration_cast<std::chrono::nanoseconds>(now).count());
    return text;
}

Result<void> write_cache_entry(const std::string& folder, const std::string& name, const std::string& text) {
    const std::string shelf = folder + "/" + name.substr(0, 2);
    std::error_code error;
    fs::create_directory(shelf, error);
    if (!is_folder_itself(shelf)) return Error{ErrorCode::io, shelf, system_reason(error ? error.value() : ENOTDIR)};
    return write_in(shelf, name, text);
}

Result<void> list_cache_entries(const std::string& folder, const std::string& head,
                                const std::function<void(CacheEntry)>& found) {
    const int failed = list_folder(folder, [&](const std::string& first) {
        if (first.size() != 2 || !is_hex(first) || !is_folder_itself(folder + "/" + first)) return;
        std::ignore = list_folder(folder + "/" + first, [&](const std::string& name) {
            if (name.size() != 64 || !is_hex(name) || !name.starts_with(first)) return;
            FileStatus status;
            if (begins_with(folder + "/" + first + "/" + name, head, status)) found({name, status.mtime, status.size});
        });
    });
    return failed == 0 ? Result<void>() : Error{ErrorCode::io, folder, system_reason(failed)};
}

bool remove_cache_entry(const std::string& folder, const std::string& name, const std::string& head) {
    const std::string path = folder + "/" + name.substr(0, 2) + "/" + name;
    FileStatus status;
    return is_folder_itself(folder + "/" + name.substr(0, 2)) && begins_with(path, head, status) && remove_file(path);
}

}  // namespace tex::cli
