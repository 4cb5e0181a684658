// SPDX-License-Identifier: Apache-2.0
// dds_format.h: what the pixel format of a DDS file means, given as FourCC, masks or DXGI number.

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tex/format.h>
#include <tex/types.h>

#include "formats/dds/fields.h"

namespace tex::inline v1 {

// DDS_PIXELFORMAT without the size field.
struct DdsPixelFormat {
    std::uint32_t flags = 0;
    std::uint32_t four_cc = 0;
    std::uint32_t bit_count = 0;  // bits of a texel; with a FourCC, tools put a swizzle code here
    std::array<std::uint32_t, 4> masks = {};
};

// DDS_PIXELFORMAT::dwFlags (ddraw.h; 0x80000000 is NVIDIA's).
inline constexpr std::uint32_t kDdpfAlphaPixels = 0x1;
inline constexpr std::uint32_t kDdpfAlpha = 0x2;
inline constexpr std::uint32_t kDdpfFourCc = 0x4;
inline constexpr std::uint32_t kDdpfRgb = 0x40;
inline constexpr std::uint32_t kDdpfLuminance = 0x20000;
inline constexpr std::uint32_t kDdpfBumpDudv = 0x80000;
inline constexpr std::uint32_t kDdpfNormal = 0x80000000u;

// How the texels of a file are stored and what they mean.
struct DdsTexels {
    Format format = Format::rgba8_unorm;
    std::optional<FieldLayout> fields;  // to be converted to `format`; none: the bytes are in `format`
    Swizzle swizzle = kSwizzleXyz;
    bool swizzle_known = false;
    bool order_open = false;  // as in Texture
    bool srgb = false;
    std::vector<std::string> remarks;
};

// From a legacy header. Errors: bad_data, unsupported; the caller fills in Error::file.
[[nodiscard]] Result<DdsTexels> texels_of(const DdsPixelFormat& pixel_format);

// From the DXGI_FORMAT of a DX10 header. Errors: unsupported.
[[nodiscard]] Result<DdsTexels> texels_of_dxgi(std::uint32_t dxgi);

}  // namespace tex::inline v1
