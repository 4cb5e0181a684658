// SPDX-License-Identifier: Apache-2.0

#include "tree/beside.h"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "cli/text.h"
#include "cli/usage_error.h"
#include "files/path_names.h"
#include "tasks/name_pattern.h"

namespace tex::cli {
namespace {

namespace fs = std::filesystem;

// Stand for * and ? of the pattern, so that those in names of files are letters.
constexpr char kAny = '\1', kOne = '\2';

std::string marked(std::string pattern) {
    std::replace(pattern.begin(), pattern.end(), '*', kAny);
    std::replace(pattern.begin(), pattern.end(), '?', kOne);
    return pattern;
}

bool fits(std::string_view pattern, std::string_view name) {
    std::size_t p = 0, n = 0, star = std::string_view::npos, retry = 0;
    while (n < name.size()) {
        if (p < pattern.size() && (pattern[p] == name[n] || pattern[p] == kOne)) {
            ++p;
            ++n;
        } else if (p < pattern.size() && pattern[p] == kAny) {
            star = p++;
            retry = n;
        } else if (star != std::string_view::npos) {
            p = star + 1;
            n = ++retry;
        } else {
            return false;
        }
    }
    while (p < pattern.size() && pattern[p] == kAny) ++p;
    return p == pattern.size();
}

}  // namespace

void check_beside(const std::string& pattern) {
    const NamePattern parsed(pattern);
    for (const char* field : {"level", "format", "engine", "type", "material"}) {
        if (parsed.uses(field))
            throw UsageError(fmt::format("{{{}}} is of outputs; there are {{dir}}, {{stem}}, {{ext}}", field));
    }
    const std::size_t slash = pattern.rfind('/');
    if (slash != std::string::npos && pattern.find_first_of("*?") < slash)
        throw UsageError("* and ? stand in the last part alone");
}

const std::vector<std::string>& FilesBeside::names_in(const std::string& folder) {
    const auto [found, is_new] = names_.try_emplace(folder);
    if (!is_new) return found->second;
    const fs::path path = root_.empty() ? fs::path(folder.empty() ? "." : folder) : fs::path(root_) / folder;
    std::error_code error;
    for (fs::directory_iterator entry(path, error), end; !error && entry != end; entry.increment(error)) {
        std::error_code unknown;
        if (entry->is_regular_file(unknown)) found->second.push_back(slashed(entry->path().filename()));
    }
    return found->second;
}

bool FilesBeside::has(const std::string& pattern, const std::string& input, const std::vector<std::string>& made) {
    const std::string wanted =
        slashed(fs::path(NamePattern(marked(pattern)).expand(name_fields(input))).lexically_normal());
    const std::size_t slash = wanted.rfind('/');
    const std::string folder = slash == std::string::npos ? std::string() : wanted.substr(0, slash + 1);
    const std::string_view last = std::string_view(wanted).substr(folder.size());
    const auto& names = names_in(folder);
    return std::any_of(names.begin(), names.end(), [&](const std::string& name) {
        const std::string path = folder + name;
        return fits(last, name) && path != input && std::find(made.begin(), made.end(), path) == made.end();
    });
}

}  // namespace tex::cli
