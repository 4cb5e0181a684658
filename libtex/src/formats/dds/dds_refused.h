// SPDX-License-Identifier: Apache-2.0
// dds_refused.h: the names of DDS formats that are not read, and the program that converts them.

#pragma once

#include <cstdint>
#include <string>

#include "formats/dds/dds_format.h"

namespace tex {

// A sentence about a DXGI_FORMAT.
[[nodiscard]] std::string refused_dxgi(std::uint32_t dxgi);

// A sentence about a legacy pixel format; empty if it is none of those that have a name.
[[nodiscard]] std::string refused_legacy(const DdsPixelFormat& pixel_format);

}  // namespace tex
