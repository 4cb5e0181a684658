// SPDX-License-Identifier: Apache-2.0

#include "formats/row_target.h"

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

// Encodes pieces of work on all threads, some for each at a time.
class Workers {
public:
    Workers(RowTarget& target, const Execution& execution) : target_(target), execution_(execution) {}

    // Takes what the last rows have completed.
    Result<void> take() {
        while (std::shared_ptr<RowWork> work = target_.take_work()) waiting_.push_back(std::move(work));
        const std::size_t enough = 4 * static_cast<std::size_t>(thread_count(execution_));
        return waiting_.size() < enough ? Result<void>() : finish();
    }
    Result<void> finish() {
        std::vector<Result<void>> runs(waiting_.size());
        const auto run = [&](int begin, int) {
            const auto k = static_cast<std::size_t>(begin);
            runs[k] = waiting_[k]->run();
        };
        constexpr int kOne = 1;
        if (Result<void> done = parallel_for(execution_, static_cast<int>(waiting_.size()), kOne, run); !done)
            return done;
        for (std::size_t k = 0; k < waiting_.size(); ++k) {
            if (!runs[k]) return runs[k];
            if (Result<void> ended = target_.end_work(waiting_[k]); !ended) return ended;
        }
        waiting_.clear();
        return {};
    }

private:
    RowTarget& target_;
    const Execution execution_;
    std::vector<std::shared_ptr<RowWork>> waiting_;
};

// Asks Execution::progress from time to time, as rows of all levels are put.
class RowProgress {
public:
    RowProgress(const Execution& execution, const Texture& texture, std::size_t levels)
        : progress_(execution.progress) {
        for (std::size_t k = 0; k < levels; ++k) rows_ += texture.levels[k].extent.height;
    }
    // Before the next row.
    Result<void> next() {
        constexpr int kRowsOfAnAnswer = 64;
        const int done = done_++;
        if (!progress_ || done % kRowsOfAnAnswer != 0 || progress_(static_cast<double>(done) / rows_)) return {};
        return Error{ErrorCode::cancelled, {}, "cancelled"};
    }

private:
    const std::function<bool(double)>& progress_;
    int rows_ = 0, done_ = 0;
};

Result<void> put_level(RowTarget& target, int k, const Level& level, Workers& workers, RowProgress& progress) {
    if (!target.has_work()) return target.put(k, level.bytes.data(), level.extent.height);
    const std::size_t row_bytes = level.bytes.size() / static_cast<std::size_t>(level.extent.height);
    for (int j = 0; j < level.extent.height; ++j) {
        if (Result<void> asked = progress.next(); !asked) return asked;
        const std::byte* const row = level.bytes.data() + static_cast<std::size_t>(j) * row_bytes;
        if (Result<void> put = target.put(k, row, 1); !put) return put;
        if (Result<void> taken = workers.take(); !taken) return taken;
    }
    return {};
}

}  // namespace

Result<std::vector<std::byte>> encode_rows(OpenTarget open, const Texture& texture, bool all_levels,
                                           const Execution& execution) {
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
    Workers workers(**target, execution.quiet());
    RowProgress progress(execution, texture, levels);
    for (std::size_t k = 0; k < levels; ++k) {
        const Result<void> put = put_level(**target, static_cast<int>(k), texture.levels[k], workers, progress);
        if (!put) return put.error();
    }
    if (const Result<void> done = workers.finish(); !done) return done.error();
    if (const Result<void> done = (*target)->finish(); !done) return done.error();
    return file;
}

}  // namespace tex::inline v1
