// SPDX-License-Identifier: Apache-2.0
// row_target.h: writes a picture a few rows at a time, each level from the top.

#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include <tex/result.h>
#include <tex/texture.h>

#include "formats/file_layout.h"

namespace tex {

// Writes bytes to a file, each byte once, in any order. Errors: io, out_of_memory.
using WriteBytes = std::function<Result<void>(std::uint64_t offset, std::span<const std::byte> bytes)>;

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

    // Writes what is left to the file, after the last row. Errors: as put().
    virtual Result<void> finish() = 0;
};

// Opens a file for a texture. Errors: as encode_file().
using OpenTarget = Result<std::unique_ptr<RowTarget>> (*)(const TextureHead& head, WriteBytes write);

// Encodes all rows at once, of all levels or of the base level. Errors: those of `open` and of RowTarget.
Result<std::vector<std::byte>> encode_rows(OpenTarget open, const Texture& texture, bool all_levels);

}  // namespace tex
