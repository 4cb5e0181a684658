// SPDX-License-Identifier: Apache-2.0
// png_input.h: the bytes of a PNG file, in order, read in large pieces.

#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include <tex/types.h>

#include "files/input_file.h"

namespace tex::inline v1 {

class PngInput {
public:
    // Throws std::bad_alloc. The file must outlive this object.
    explicit PngInput(InputFile& file);

    // Puts the next `count` bytes at `to`; false if the file ends before them or cannot be read.
    [[nodiscard]] bool take(std::uint8_t* to, std::size_t count);
    // Returns the next bytes, at most `most` of them; none if the file has ended or cannot be read. They are valid
    // until the next call.
    [[nodiscard]] std::span<const std::uint8_t> some(std::size_t most);
    // Why the file could not be read, if that was so.
    [[nodiscard]] const std::optional<Error>& error() const { return error_; }

private:
    bool fill();

    InputFile& file_;
    std::unique_ptr<std::uint8_t[]> buffer_;
    std::size_t begin_ = 0;
    std::size_t end_ = 0;
    std::optional<Error> error_;
};

}  // namespace tex::inline v1
