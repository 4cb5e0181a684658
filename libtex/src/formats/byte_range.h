// SPDX-License-Identifier: Apache-2.0
// byte_range.h: reads a part of a file in its order, a piece at a time. Decoders of packets use it.

#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <tex/types.h>

#include "files/input_file.h"

namespace tex::inline v1 {

class ByteRange {
public:
    static constexpr std::size_t kMostTaken = 4096;

    // The bytes [begin, end) of a file that must outlive this object, and whose size is known.
    ByteRange(const InputFile& file, std::int64_t begin, std::int64_t end)
        : file_(file), next_(begin), end_(std::max(begin, end)) {}

    // The next `count` bytes, which stay until the next call; null if there are not that many: see error().
    // Precondition: count is at most kMostTaken. Throws std::bad_alloc.
    const std::byte* take(std::size_t count) {
        if (held_ - given_ < count && !fill(count)) return nullptr;
        const std::byte* const bytes = piece_.data() + given_;
        given_ += count;
        return bytes;
    }
    // Where take() goes on.
    [[nodiscard]] std::int64_t position() const { return next_ - static_cast<std::int64_t>(held_ - given_); }
    // Why take() returned null: io, or bad_data.
    [[nodiscard]] Error error() const;

private:
    bool fill(std::size_t count);

    const InputFile& file_;
    std::int64_t next_;  // the byte after those that are held
    const std::int64_t end_;
    std::vector<std::byte> piece_;
    std::size_t held_ = 0, given_ = 0;
    std::optional<Error> failure_;
};

// What is wrong with a picture whose file ends within its rows.
[[nodiscard]] Error ends_early(const InputFile& file);

}  // namespace tex::inline v1
