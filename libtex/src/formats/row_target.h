// SPDX-License-Identifier: Apache-2.0
// row_target.h: writes a picture a few rows at a time, each level from the top.

#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <tex/format.h>
#include <tex/types.h>

#include "formats/file_layout.h"

namespace tex::inline v1 {

// Writes bytes to a file, each byte once, in any order. Errors: io, out_of_memory.
using WriteBytes = std::function<Result<void>(std::uint64_t offset, std::span<const std::byte> bytes)>;

// Rows that are encoded apart from all others.
class RowWork {
public:
    RowWork() = default;
    RowWork(const RowWork&) = delete;
    RowWork& operator=(const RowWork&) = delete;
    virtual ~RowWork() = default;

    // Encodes the rows. Throws std::bad_alloc. Errors: unsupported, with the library's reason.
    virtual Result<void> run() = 0;
};

class RowTarget {
public:
    RowTarget() = default;
    RowTarget(const RowTarget&) = delete;
    RowTarget& operator=(const RowTarget&) = delete;
    virtual ~RowTarget() = default;

    // Takes the next `count` rows of a level, in the format of the head. Levels may come in any order, and rows of
    // different levels may alternate. Throws std::bad_alloc. Errors: unsupported, with the library's reason; those of
    // WriteBytes.
    virtual Result<void> put(int level, const std::byte* rows, int count) = 0;

    // Whether put() only collects rows, for work that is taken, run and ended. The run() of several may take place at
    // once, on any threads; no two calls of other functions may.
    [[nodiscard]] virtual bool has_work() const { return false; }

    // Allows a scratch file beside the file `output`, for what has been encoded and waits for its place. To be called
    // before put(). Without it, that waits in memory.
    virtual void wait_beside(const std::string& /*output*/) {}

    // Returns work whose rows have all been put, or null if there is none. Throws std::bad_alloc.
    virtual std::shared_ptr<RowWork> take_work() { return nullptr; }

    // Writes the result of work that has been run, and of all earlier work, as soon as that has ended, too. Throws
    // std::bad_alloc. Errors: as put().
    virtual Result<void> end_work(const std::shared_ptr<RowWork>& /*work*/) { return {}; }

    // Writes what is left to the file, after the last row and the end of all work. Errors: as put().
    virtual Result<void> finish() = 0;
};

// Opens a file for a texture. Errors: as encode_file().
using OpenTarget = Result<std::unique_ptr<RowTarget>> (*)(const TextureHead& head, WriteBytes write);

// Encodes all rows at once, of all levels or of the base level. Errors: those of `open` and of RowTarget,
// out_of_memory, cancelled.
Result<std::vector<std::byte>> encode_rows(OpenTarget open, const Texture& texture, bool all_levels,
                                           const Execution& execution = {1, {}});

}  // namespace tex::inline v1
