// SPDX-License-Identifier: Apache-2.0
// bottom_up.h: writes files of 8-bit texels whose rows run from the bottom and whose colours are stored as blue, green,
// red: TGA and BMP.

#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "formats/row_target.h"

namespace tex::inline v1 {

struct BottomUpFile {
    Format format;  // 8-bit unorm, of one, three or four channels
    Extent extent;
    std::vector<std::byte> head;
    std::size_t alignment;  // rows have a multiple of this number of bytes
    std::vector<std::byte> tail;
};

// Throws std::bad_alloc.
std::unique_ptr<RowTarget> open_bottom_up(BottomUpFile file, WriteBytes write);

}  // namespace tex::inline v1
