// SPDX-License-Identifier: Apache-2.0
// format_codes.h: the table of the numbers that identify a format in files, one row for each format.

#pragma once

#include <cstdint>
#include <optional>

#include <tex/format.h>

#include "formats/dds/dds_format.h"

namespace tex::inline v1 {

// The numbers of one registry for a format; 0 if there is none. All of them describe the same bytes.
struct FormatNumbers {
    std::uint32_t exact = 0;
    std::uint32_t srgb = 0;
    std::uint32_t typeless = 0;
};

struct FormatCodes {
    Format format;
    DdsPixelFormat legacy;    // in a Direct3D 9 header; flags are 0 if Direct3D 9 lacks the format
    FormatNumbers dxgi;       // DXGI_FORMAT
    FormatNumbers vk;         // VkFormat
    std::uint32_t khr_model;  // khr_df_model_e
    FormatNumbers gl = {};    // glInternalFormat of OpenGL, for formats with blocks
};

[[nodiscard]] const FormatCodes& codes_of(Format format);

// The format that a number identifies, and whether the number declares sRGB; nullopt for unknown numbers.
struct MarkedFormat {
    Format format;
    bool srgb;
};
[[nodiscard]] std::optional<MarkedFormat> find_format(FormatNumbers FormatCodes::*registry, std::uint32_t number);

// From khr_df.h of the Khronos Data Format Specification.
inline constexpr std::uint32_t kKhrRgbsda = 1;
inline constexpr std::uint32_t kKhrBc1 = 128;
inline constexpr std::uint32_t kKhrBc2 = 129;
inline constexpr std::uint32_t kKhrBc3 = 130;
inline constexpr std::uint32_t kKhrBc4 = 131;
inline constexpr std::uint32_t kKhrBc5 = 132;
inline constexpr std::uint32_t kKhrBc6h = 133;
inline constexpr std::uint32_t kKhrBc7 = 134;
inline constexpr std::uint32_t kKhrEtc2 = 161;  // including EAC
inline constexpr std::uint32_t kKhrAstc = 162;

}  // namespace tex::inline v1
