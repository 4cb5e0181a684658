// SPDX-License-Identifier: Apache-2.0

#include "formats/row_target.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace tex {
namespace {

Result<void> do_work(RowTarget& target) {
    while (const std::shared_ptr<RowWork> work = target.take_work()) {
        if (Result<void> run = work->run(); !run) return run;
        if (Result<void> ended = target.end_work(work); !ended) return ended;
    }
    return {};
}

Result<void> put_level(RowTarget& target, int k, const Level& level) {
    if (!target.has_work()) return target.put(k, level.bytes.data(), level.extent.height);
    const std::size_t row_bytes = level.bytes.size() / static_cast<std::size_t>(level.extent.height);
    for (int j = 0; j < level.extent.height; ++j) {
        const std::byte* const row = level.bytes.data() + static_cast<std::size_t>(j) * row_bytes;
        if (Result<void> put = target.put(k, row, 1); !put) return put;
        if (Result<void> done = do_work(target); !done) return done;
    }
    return {};
}

}  // namespace

Result<std::vector<std::byte>> encode_rows(OpenTarget open, const Texture& texture, bool all_levels) {
    if (texture.levels.empty()) return Error{ErrorCode::unsupported, {}, "a texture without levels"};
    std::vector<std::byte> file;
    const WriteBytes write = [&file](std::uint64_t offset, std::span<const std::byte> bytes) -> Result<void> {
        const auto at = static_cast<std::size_t>(offset);
        file.resize(std::max(file.size(), at + bytes.size()));
        std::copy(bytes.begin(), bytes.end(), file.begin() + static_cast<std::ptrdiff_t>(at));
        return {};
    };
    const Result<std::unique_ptr<RowTarget>> target = open(head_of(texture), write);
    if (!target) return target.error();
    const std::size_t levels = all_levels ? texture.levels.size() : 1;
    for (std::size_t k = 0; k < levels; ++k) {
        const Result<void> put = put_level(**target, static_cast<int>(k), texture.levels[k]);
        if (!put) return put.error();
    }
    if (const Result<void> done = (*target)->finish(); !done) return done.error();
    return file;
}

}  // namespace tex
