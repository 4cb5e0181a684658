// SPDX-License-Identifier: Apache-2.0

#include "tasks/udim.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "cli/text.h"
#include "cli/usage_error.h"
#include "files/path_names.h"
#include "files/system_error.h"

namespace tex::cli {
namespace {

namespace fs = std::filesystem;

constexpr int kFirstTile = 1001;
constexpr int kLastTile = 9999;  // four digits

// The number of the tile whose name `file` is, or 0.
int tile_of(const std::string& pattern, const std::string& file) {
    const std::size_t mark = pattern.find(kTileMark);
    if (file.size() < mark + 4) return 0;
    int tile = 0;
    for (std::size_t k = mark; k < mark + 4; ++k) {
        if (file[k] < '0' || file[k] > '9') return 0;
        tile = 10 * tile + (file[k] - '0');
    }
    return tile >= kFirstTile && tile <= kLastTile && with_tile(pattern, tile) == file ? tile : 0;
}

}  // namespace

bool has_tile(std::string_view name) { return name.find(kTileMark) != std::string_view::npos; }

std::string with_tile(const std::string& name, int tile) {
    std::string text = name;
    if (tile == 0) return text;
    for (std::size_t mark = text.find(kTileMark); mark != std::string::npos; mark = text.find(kTileMark))
        text.replace(mark, kTileMark.size(), std::to_string(tile));
    return text;
}

Result<std::vector<Input>> inputs_of(const std::string& name) {
    if (!has_tile(name)) return std::vector<Input>{{name}};
    const fs::path path(name);
    if (has_tile(slashed(path.parent_path())))
        throw UsageError(
            fmt::format("{}: <UDIM> stands for digits in the name of a file, not of a folder", printable(name)));
    const fs::path folder = path.parent_path().empty() ? fs::path(".") : path.parent_path();
    std::vector<Input> inputs;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        const int tile = tile_of(slashed(path.filename()), slashed(entry->path().filename()));
        if (tile != 0) inputs.push_back({slashed(path.parent_path() / entry->path().filename()), tile, name});
    }
    if (error) return Error{ErrorCode::io, slashed(folder), "cannot be read: " + system_reason(error.value())};
    if (inputs.empty()) return Error{ErrorCode::io, name, "no file has this name with the number of a UDIM tile"};
    std::sort(inputs.begin(), inputs.end(), [](const Input& a, const Input& b) { return a.tile < b.tile; });
    return inputs;
}

}  // namespace tex::cli
