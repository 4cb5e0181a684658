// SPDX-License-Identifier: Apache-2.0

#include "batch/up_to_date.h"

#include <algorithm>
#include <tuple>

#include "cli/file_status.h"
#include "tasks/name_pattern.h"

namespace tex::cli {
std::optional<std::int64_t> latest_change(const Task& task) {
    std::vector<std::string> files = task.prerequisites();
    files.push_back(task.input);
    std::int64_t latest = 0;
    for (const std::string& file : files) {
        const auto status = file == "-" ? std::nullopt : status_of(file);
        if (!status || !status->is_regular()) return std::nullopt;
        latest = std::max({latest, status->mtime, status->ctime});
    }
    return latest;
}

bool is_up_to_date(const Task& task, std::int64_t change) {
    const std::vector<std::string> outputs = task.outputs();
    return std::all_of(outputs.begin(), outputs.end(), [change](const std::string& output) {
        if (has_level(output)) return false;
        const auto status = status_of(output);
        return status && status->is_regular() && status->size > 0 && status->mtime > change;
    });
}

void make_outdated(const Task& task, std::int64_t change) {
    for (const std::string& output : task.outputs()) {
        // If this fails, the output was removed or belongs to somebody else by now.
        if (!has_level(output)) std::ignore = set_mtime(output, change);
    }
}

}  // namespace tex::cli
