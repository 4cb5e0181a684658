// SPDX-License-Identifier: Apache-2.0
// dds_refused.h: the names of DDS formats that are not read, and the program that converts them.

#pragma once

#include <cstdint>
#include <string>

#include "formats/dds/dds_format.h"

namespace tex::inline v1 {

// A sentence about a DXGI_FORMAT.
[[nodiscard]] std::string refused_dxgi(std::uint32_t dxgi);

// Describes a legacy pixel format in one sentence. Empty if the format has no name.
[[nodiscard]] std::string refused_legacy(const DdsPixelFormat& pixel_format);

}  // namespace tex::inline v1
