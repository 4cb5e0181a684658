// SPDX-License-Identifier: Apache-2.0

#include "tasks/written_levels.h"

#include <utility>
#include <vector>

#include "tasks/name_pattern.h"

namespace tex::cli {

LevelNames level_names(const std::string& name) {
    if (!has_level(name)) return {};
    return [name](int level) { return with_level(name, level); };
}

void wrote_levels(Job& job, const std::string& name, int levels) {
    for (int k = 0; k < (has_level(name) ? levels : 1); ++k) job.wrote(with_level(name, k));
}

Result<WrittenLevels> write_levels(Job& job, Texture texture, const WriteOptions& options) {
    const bool by_level = has_level(job.task.output);
    if (!by_level && !can_hold_levels(job.task.container)) texture.levels.resize(1);
    WrittenLevels written{static_cast<int>(texture.levels.size()), 0};
    std::vector<Level> levels;
    if (by_level) levels = std::exchange(texture.levels, {});
    for (int k = 0; k < (by_level ? written.levels : 1); ++k) {
        if (by_level) texture.levels = {std::move(levels[static_cast<std::size_t>(k)])};
        const std::string name = with_level(job.task.output, k);
        const auto bytes = encode_file(texture, job.task.container, options, {job.threads(), {}});
        if (!bytes) return bytes.error().of(name);
        if (const auto done = write_file(name, *bytes, options); !done) return done.error();
        written.bytes += bytes->size();
    }
    wrote_levels(job, job.task.output, written.levels);
    return written;
}

}  // namespace tex::cli
