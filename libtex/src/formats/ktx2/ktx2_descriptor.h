// SPDX-License-Identifier: Apache-2.0
// ktx2_descriptor.h: how a KTX 2 file describes its format beside the VkFormat.

#pragma once

#include <cstddef>
#include <vector>

#include <tex/format.h>

namespace tex {

// The basic data format descriptor block of a format (Khronos Data Format Specification 1.3, section 5), with the
// total size in front: linear transfer, no colour primaries, as normals are not colours.
[[nodiscard]] std::vector<std::byte> data_format_descriptor(Format format);

}  // namespace tex
