// SPDX-License-Identifier: Apache-2.0
// dds_file.h: DDS files written without libtex, so that every field of both headers can have any value.
//
// Source: "Programming Guide for DDS", "DDS_HEADER", "DDS_PIXELFORMAT" and "DDS_HEADER_DXT10" (Microsoft).

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace tex::reference {

// The 32-bit fields in their order, each named by its offset in the file.
namespace dds {
inline constexpr std::size_t kMagic = 0, kSize = 4, kFlags = 8, kHeight = 12, kWidth = 16, kPitch = 20, kDepth = 24,
                             kMipCount = 28, kReserved = 32, kFormatSize = 76, kFormatFlags = 80, kFourCc = 84,
                             kBitCount = 88, kMasks = 92, kCaps = 108, kCaps2 = 112, kCaps3 = 116, kCaps4 = 120,
                             kReserved2 = 124, kHeaderEnd = 128, kDxgi = 128, kDimension = 132, kMiscFlag = 136,
                             kArraySize = 140, kMiscFlags2 = 144, kHeader10End = 148;
}  // namespace dds

constexpr std::uint32_t four_cc(std::string_view text) {
    std::uint32_t value = 0;
    for (std::size_t k = 4; k-- > 0;) value = value << 8 | static_cast<unsigned char>(text[k]);
    return value;
}

struct DdsFile {
    std::array<std::uint32_t, dds::kHeader10End / 4> fields{};
    bool has_header10 = false;
    std::string data;

    std::uint32_t& operator[](std::size_t offset) { return fields[offset / 4]; }
};

inline std::string write_dds(const DdsFile& file) {
    std::string bytes;
    for (std::size_t k = 0; k < (file.has_header10 ? dds::kHeader10End : dds::kHeaderEnd) / 4; ++k) {
        for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(file.fields[k] >> shift & 0xff);
    }
    return bytes + file.data;
}

// The fields that every file has. Flags: caps, height, width, pixel format; with several levels also their count.
inline DdsFile dds_header(std::uint32_t width, std::uint32_t height, std::uint32_t levels) {
    DdsFile file;
    file[dds::kMagic] = four_cc("DDS ");
    file[dds::kSize] = 124;
    file[dds::kFlags] = 0x1007 | (levels > 1 ? 0x20000 : 0);
    file[dds::kHeight] = height;
    file[dds::kWidth] = width;
    file[dds::kMipCount] = levels;
    file[dds::kFormatSize] = 32;
    file[dds::kCaps] = 0x1000 | (levels > 1 ? 0x400008 : 0);
    return file;
}

// With a four-letter code, or a code of Direct3D 9.
inline DdsFile dds_coded(std::uint32_t width, std::uint32_t height, std::uint32_t levels, std::uint32_t code) {
    DdsFile file = dds_header(width, height, levels);
    file[dds::kFormatFlags] = 4;
    file[dds::kFourCc] = code;
    return file;
}

// With the header of Direct3D 10: one two-dimensional texture.
inline DdsFile dds_dxgi(std::uint32_t width, std::uint32_t height, std::uint32_t levels, std::uint32_t format) {
    DdsFile file = dds_coded(width, height, levels, four_cc("DX10"));
    file.has_header10 = true;
    file[dds::kDxgi] = format;
    file[dds::kDimension] = 3;
    file[dds::kArraySize] = 1;
    return file;
}

}  // namespace tex::reference
