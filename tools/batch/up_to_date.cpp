// SPDX-License-Identifier: Apache-2.0

#include "batch/up_to_date.h"

#include <algorithm>
#include <tuple>

#include <fcntl.h>
#include <sys/stat.h>

#include "tasks/name_pattern.h"

namespace tex::cli {
namespace {

constexpr std::int64_t kSecond = 1000000000;

std::int64_t nanoseconds(const timespec& time) { return std::int64_t{time.tv_sec} * kSecond + time.tv_nsec; }

}  // namespace

std::optional<std::int64_t> latest_change(const Task& task) {
    std::vector<std::string> files = task.prerequisites();
    files.push_back(task.input);
    std::int64_t latest = 0;
    for (const std::string& file : files) {
        struct stat status {};
        if (file == "-" || stat(file.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
        latest = std::max({latest, nanoseconds(status.st_mtim), nanoseconds(status.st_ctim)});
    }
    return latest;
}

bool is_up_to_date(const Task& task, std::int64_t change) {
    const std::vector<std::string> outputs = task.outputs();
    return std::all_of(outputs.begin(), outputs.end(), [change](const std::string& output) {
        struct stat status {};
        return !has_level(output) && stat(output.c_str(), &status) == 0 && S_ISREG(status.st_mode) &&
               status.st_size > 0 && nanoseconds(status.st_mtim) > change;
    });
}

void make_outdated(const Task& task, std::int64_t change) {
    const timespec time{change / kSecond, change % kSecond};
    const timespec times[] = {{0, UTIME_OMIT}, time};
    for (const std::string& output : task.outputs()) {
        // If this fails, the output was removed or belongs to somebody else by now.
        if (!has_level(output)) std::ignore = utimensat(AT_FDCWD, output.c_str(), times, 0);
    }
}

}  // namespace tex::cli
