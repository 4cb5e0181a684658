// SPDX-License-Identifier: Apache-2.0
// ktx2_descriptor.h: the descriptor that a KTX 2 file holds in addition to the VkFormat.

#pragma once

#include <cstddef>
#include <vector>

#include <tex/format.h>

namespace tex::inline v1 {

// The basic data format descriptor block of a format (Khronos Data Format Specification 1.3, section 5), preceded by
// the total size. It states linear transfer and no colour primaries, because normals are not colours.
[[nodiscard]] std::vector<std::byte> data_format_descriptor(Format format, const Swizzle& layout = kSwizzleXyz);

}  // namespace tex::inline v1
