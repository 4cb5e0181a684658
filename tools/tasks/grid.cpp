// SPDX-License-Identifier: Apache-2.0

#include "tasks/grid.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <functional>
#include <map>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "cli/text.h"
#include "cli/usage_error.h"
#include "files/path_names.h"
#include "files/system_error.h"
#include "tasks/task.h"

namespace tex::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kColumnMark = "{x}", kRowMark = "{y}";

// The length of the number at the beginning of a text: digits, perhaps after a minus.
std::size_t number_length(std::string_view text) {
    const std::size_t sign = text.starts_with('-') ? 1 : 0;
    std::size_t end = sign;
    while (end < text.size() && text[end] >= '0' && text[end] <= '9') ++end;
    return end > sign ? end : 0;
}

// Takes the numbers of a name; false if the name does not match the pattern.
bool match(std::string_view pattern, std::string_view name, TilePosition& place) {
    while (!pattern.empty()) {
        const bool is_column = pattern.starts_with(kColumnMark);
        if (!is_column && !pattern.starts_with(kRowMark)) {
            if (name.empty() || name[0] != pattern[0]) return false;
            pattern.remove_prefix(1);
            name.remove_prefix(1);
            continue;
        }
        const std::string_view number = name.substr(0, number_length(name));
        std::string& text = is_column ? place.x_text : place.y_text;
        int& value = is_column ? place.x : place.y;
        if (number.empty() || (!text.empty() && text != number)) return false;
        if (std::from_chars(number.data(), number.data() + number.size(), value).ec != std::errc()) return false;
        text = number;
        pattern.remove_prefix(kColumnMark.size());
        name.remove_prefix(number.size());
    }
    return name.empty();
}

bool has_mark(std::string_view text) {
    return text.find(kColumnMark) != std::string_view::npos || text.find(kRowMark) != std::string_view::npos;
}

// Follows the components of the pattern from `next` on, below `folder`.
Result<void> find_below(const fs::path& folder, fs::path::iterator next, fs::path::iterator end,
                        const TilePosition& place, std::vector<GridFile>& found) {
    if (next == end) {
        found.push_back({slashed(folder), place});
        return {};
    }
    const std::string component = next->string();
    const fs::path::iterator after = std::next(next);
    if (!has_mark(component)) {
        std::error_code error;
        const fs::path path = folder / component;
        return fs::exists(path, error) ? find_below(path, after, end, place, found) : Result<void>();
    }
    std::error_code error;
    for (fs::directory_iterator entry(folder.empty() ? fs::path(".") : folder, error), last; !error && entry != last;
         entry.increment(error)) {
        TilePosition its = place;
        const std::string name = slashed(entry->path().filename());
        if (!match(component, name, its)) continue;
        if (after != end && !entry->is_directory(error)) continue;
        if (Result<void> done = find_below(folder / name, after, end, its, found); !done) return done;
    }
    return error
               ? Result<void>(Error{ErrorCode::io, slashed(folder), "cannot be read: " + system_reason(error.value())})
               : Result<void>();
}

void check_marks(const std::string& pattern) {
    if (pattern.find("{x}{y}") != std::string::npos || pattern.find("{y}{x}") != std::string::npos)
        throw UsageError(fmt::format("{}: something must stand between {{x}} and {{y}}", printable(pattern)));
}

using Tiles = std::map<std::pair<int, int>, const std::string*>;  // by y and x

// The place one step from `at` along an axis: the next tile or, if the heights repeat, the one at the other end. None:
// there is no tile.
std::optional<int> step(int at, int by, Wrap wrap, const std::function<bool(int)>& exists) {
    if (by == 0) return at;
    if (exists(at + by)) return at + by;
    if (wrap != Wrap::repeat) return std::nullopt;
    while (exists(at - by)) at -= by;
    return at;
}

}  // namespace

bool has_grid(std::string_view name) {
    return name.find(kColumnMark) != std::string_view::npos && name.find(kRowMark) != std::string_view::npos;
}

std::optional<TilePosition> place_in_grid(const std::string& pattern, const std::string& path) {
    TilePosition place;
    return match(pattern, path, place) ? std::optional(std::move(place)) : std::nullopt;
}

std::string grid_glob(const std::string& pattern) {
    check_marks(pattern);
    std::string glob = with_grid(pattern, {0, 0, "", ""});
    if (glob.find_first_of("*?[{\\") != std::string::npos)
        throw UsageError(fmt::format("{}: a name with {{x}} and {{y}} has no other wildcards", printable(pattern)));
    return with_grid(pattern, {0, 0, "*", "*"});
}

std::string with_grid(std::string name, const TilePosition& place) {
    for (const auto& [mark, text] : {std::pair(kColumnMark, place.x_text), std::pair(kRowMark, place.y_text)}) {
        for (std::size_t at = name.find(mark); at != std::string::npos; at = name.find(mark, at + text.size()))
            name.replace(at, mark.size(), text);
    }
    return name;
}

Result<std::vector<GridFile>> grid_files(const std::string& pattern) {
    check_marks(pattern);
    std::vector<GridFile> found;
    const fs::path path(pattern);
    if (const Result<void> done = find_below({}, path.begin(), path.end(), {}, found); !done) return done.error();
    if (found.empty()) return Error{ErrorCode::io, pattern, "no file has this name with numbers for {x} and {y}"};
    std::sort(found.begin(), found.end(), [](const GridFile& a, const GridFile& b) {
        return std::pair(a.place.y, a.place.x) < std::pair(b.place.y, b.place.x);
    });
    const auto same = std::adjacent_find(found.begin(), found.end(), [](const GridFile& a, const GridFile& b) {
        return a.place.x == b.place.x && a.place.y == b.place.y;
    });
    if (same != found.end())
        throw UsageError(
            fmt::format("{} and {} are the same tile", printable(same->name), printable((same + 1)->name)));
    return found;
}

void find_tiles_around(std::vector<Task>& tasks, Wrap wrap_x, Wrap wrap_y, bool upwards) {
    std::map<std::string, Tiles> grids;
    for (const Task& task : tasks) grids[task.pattern][{task.place->y, task.place->x}] = &task.input;
    for (Task& task : tasks) {
        const Tiles& tiles = grids[task.pattern];
        const int x = task.place->x, y = task.place->y;
        task.around.assign(9, {});
        for (int down = -1; down <= 1; ++down) {
            const auto its_y = step(y, upwards ? -down : down, wrap_y, [&](int k) { return tiles.contains({k, x}); });
            for (int right = -1; right <= 1 && its_y; ++right) {
                const auto its_x = step(x, right, wrap_x, [&](int k) { return tiles.contains({*its_y, k}); });
                if (!its_x || (right == 0 && down == 0)) continue;
                const std::string& name = *tiles.at({*its_y, *its_x});
                task.around[static_cast<std::size_t>(3 * (down + 1) + right + 1)] = name;
                if (name != task.input && std::find(task.own.begin(), task.own.end(), name) == task.own.end())
                    task.own.push_back(name);
            }
        }
    }
}

}  // namespace tex::cli
