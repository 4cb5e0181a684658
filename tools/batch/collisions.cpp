// SPDX-License-Identifier: Apache-2.0

#include "batch/collisions.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <sys/stat.h>
#include <tex/mip_chain.h>
#include <unistd.h>

#include "batch/name_pattern.h"
#include "batch/task.h"
#include "cli/text.h"
#include "cli/usage_error.h"
#include "options/engines.h"
#include "options/files.h"

namespace tex::cli {
namespace {

namespace fs = std::filesystem;

using Identity = std::pair<dev_t, ino_t>;

// Identifies the file behind an existing path; for "-", the file behind the descriptor `standard`. Returns nothing for
// pipes, devices and paths that do not exist.
std::optional<Identity> identity(const std::string& path, int standard) {
    struct stat status {};
    const int failed = path == "-" ? fstat(standard, &status) : stat(path.c_str(), &status);
    if (failed != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
    return Identity{status.st_dev, status.st_ino};
}
std::optional<Identity> input_identity(const std::string& path) { return identity(path, STDIN_FILENO); }
std::optional<Identity> output_identity(const std::string& path) { return identity(path, STDOUT_FILENO); }

bool is_special(const std::string& path) {
    struct stat status {};
    return path == "-" || (stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode));
}

// Returns the same spelling for all names of one path, even if the path does not exist. Follows symbolic links,
// including dangling ones, because a write goes to the link's target.
std::string canonical(const std::string& path) {
    std::error_code error;
    fs::path at = path;
    constexpr int kMostLinks = 40;  // the kernel's limit; opening a file behind more links is an error
    for (int k = 0; k < kMostLinks; ++k) {
        const fs::path target = fs::read_symlink(at, error);
        if (error) break;
        at = at.parent_path() / target;
    }
    const fs::path folder = fs::weakly_canonical(fs::absolute(at, error).parent_path(), error);
    return (folder / at.filename()).string();
}

// The files that a task writes. If each level has its own file, this is one name for each level that the largest
// possible extent could have.
std::vector<std::string> files_of(const Task& task) {
    std::vector<std::string> files;
    for (const std::string& output : task.outputs()) {
        const int levels = has_level(output) ? level_count({kMaxExtent, 1}) : 1;
        for (int level = 0; level < levels; ++level) files.push_back(with_level(output, level));
    }
    return files;
}

}  // namespace

void check_collisions(const std::vector<Task>& tasks, const std::string& depfile, const std::string& list) {
    std::map<Identity, std::string> inputs;
    if (const auto file = input_identity(list)) inputs.emplace(*file, list);
    for (const Task& task : tasks) {
        if (const auto file = input_identity(task.input)) inputs.emplace(*file, task.input);
        for (const std::string& input : task.prerequisites()) {
            if (const auto file = input_identity(input)) inputs.emplace(*file, input);
        }
    }
    const auto check_not_an_input = [&](const std::string& path) {
        const auto file = output_identity(path);
        if (!file) return;
        const auto input = inputs.find(*file);
        if (input == inputs.end()) return;
        throw UsageError(fmt::format("the output {} is the input {}", printable(path), printable(input->second)));
    };

    std::map<std::string, const Task*> by_name;
    std::map<Identity, const Task*> by_identity;
    for (const Task& task : tasks) {
        for (const std::string& path : files_of(task)) {
            check_not_an_input(path);
            if (is_special(path)) continue;
            const auto [same, is_new] = by_name.emplace(canonical(path), &task);
            const Task* other = is_new ? nullptr : same->second;
            if (const auto file = output_identity(path); file && other == nullptr) {
                const auto [linked, is_new_file] = by_identity.emplace(*file, &task);
                if (!is_new_file) other = linked->second;
            }
            if (other == &task) {
                throw UsageError(
                    fmt::format("two outputs of {} are one file, {}", printable(task.input), printable(path)));
            }
            if (other != nullptr && other->engine != task.engine && other->input == task.input) {
                throw UsageError(
                    fmt::format("{} for {} and for {} have the same output {}; {{engine}} in --name separates "
                                "them",
                                printable(task.input), other->engine->name, task.engine->name, printable(path)));
            }
            if (other != nullptr) {
                throw UsageError(fmt::format("{} and {} have the same output {}", printable(other->input),
                                             printable(task.input), printable(path)));
            }
        }
    }
    if (depfile.empty()) return;
    check_not_an_input(depfile);
    if (by_name.contains(canonical(depfile)))
        throw UsageError(fmt::format("--depfile: {} is an output", printable(depfile)));
}

void check_document(const NamedFile& document, const std::vector<std::string>& inputs,
                    const std::vector<NamedFile>& others) {
    const auto& [option, path] = document;
    if (path.empty() || path == "-") throw UsageError(fmt::format("{} needs the name of a file", option));
    if (is_folder(path)) throw UsageError(fmt::format("{} {}: is a folder", option, printable(path)));
    if (is_special(path)) return;
    const auto same = [name = canonical(path), file = output_identity(path)](const std::string& other) {
        return !other.empty() &&
               ((other != "-" && canonical(other) == name) || (file && input_identity(other) == file));
    };
    for (const std::string& input : inputs) {
        if (same(input))
            throw UsageError(fmt::format("{}: {} is the input {}", option, printable(path), printable(input)));
    }
    for (const NamedFile& other : others) {
        if (same(other.path))
            throw UsageError(fmt::format("{}: {} is the file of {}", option, printable(path), other.option));
    }
}

void check_read_twice(const std::string& option, const std::vector<std::string>& inputs) {
    if (std::find(inputs.begin(), inputs.end(), "-") == inputs.end()) return;
    throw UsageError(fmt::format("{} reads its inputs twice, which standard input does not allow", option));
}

}  // namespace tex::cli
