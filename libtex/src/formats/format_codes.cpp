// SPDX-License-Identifier: Apache-2.0

#include "formats/format_codes.h"

#include <algorithm>
#include <iterator>

#include "formats/bytes.h"

namespace tex::inline v1 {
namespace {

constexpr DdsPixelFormat coded(std::uint32_t code) { return {kDdpfFourCc, code, 0, {}}; }

constexpr DdsPixelFormat kNone = {};
constexpr DdsPixelFormat kL8 = {kDdpfLuminance, 0, 8, {0xff, 0, 0, 0}};
constexpr DdsPixelFormat kL16 = {kDdpfLuminance, 0, 16, {0xffff, 0, 0, 0}};
// Blue first, as Direct3D 9 stores it: some readers (ImageMagick 6) ignore the masks.
constexpr DdsPixelFormat kRgb8 = {kDdpfRgb, 0, 24, {0xff0000, 0xff00, 0xff, 0}};
constexpr DdsPixelFormat kRgba8 = {kDdpfRgb | kDdpfAlphaPixels, 0, 32, {0xff0000, 0xff00, 0xff, 0xff000000}};

// In the order of Format. The Direct3D 9 numbers are D3DFORMATs.
constexpr FormatCodes kMarks[] = {
    {Format::bc1_unorm, coded(fourcc("DXT1")), {71, 72, 70}, {133, 134}, kKhrBc1, {0x83f1, 0x8c4d, 0x83f0}},
    {Format::bc2_unorm, coded(fourcc("DXT3")), {74, 75, 73}, {135, 136}, kKhrBc2, {0x83f2, 0x8c4e}},
    {Format::bc3_unorm, coded(fourcc("DXT5")), {77, 78, 76}, {137, 138}, kKhrBc3, {0x83f3, 0x8c4f}},
    {Format::bc4_unorm, coded(fourcc("ATI1")), {80, 0, 79}, {139}, kKhrBc4, {0x8dbb}},
    {Format::bc4_snorm, coded(fourcc("BC4S")), {81}, {140}, kKhrBc4, {0x8dbc}},
    {Format::bc5_unorm, coded(fourcc("ATI2")), {83, 0, 82}, {141}, kKhrBc5, {0x8dbd}},
    {Format::bc5_snorm, coded(fourcc("BC5S")), {84}, {142}, kKhrBc5, {0x8dbe}},
    {Format::bc6h_ufloat, kNone, {95, 0, 94}, {143}, kKhrBc6h, {0x8e8f}},
    {Format::bc6h_sfloat, kNone, {96}, {144}, kKhrBc6h, {0x8e8e}},
    {Format::bc7_unorm, kNone, {98, 99, 97}, {145, 146}, kKhrBc7, {0x8e8c, 0x8e8d}},
    {Format::eac_r11_unorm, kNone, {}, {153}, kKhrEtc2, {0x9270}},
    {Format::eac_r11_snorm, kNone, {}, {154}, kKhrEtc2, {0x9271}},
    {Format::eac_rg11_unorm, kNone, {}, {155}, kKhrEtc2, {0x9272}},
    {Format::eac_rg11_snorm, kNone, {}, {156}, kKhrEtc2, {0x9273}},
    {Format::astc_4x4_unorm, kNone, {}, {157, 158}, kKhrAstc, {0x93b0, 0x93d0}},
    {Format::astc_5x4_unorm, kNone, {}, {159, 160}, kKhrAstc, {0x93b1, 0x93d1}},
    {Format::astc_5x5_unorm, kNone, {}, {161, 162}, kKhrAstc, {0x93b2, 0x93d2}},
    {Format::astc_6x5_unorm, kNone, {}, {163, 164}, kKhrAstc, {0x93b3, 0x93d3}},
    {Format::astc_6x6_unorm, kNone, {}, {165, 166}, kKhrAstc, {0x93b4, 0x93d4}},
    {Format::astc_8x5_unorm, kNone, {}, {167, 168}, kKhrAstc, {0x93b5, 0x93d5}},
    {Format::astc_8x6_unorm, kNone, {}, {169, 170}, kKhrAstc, {0x93b6, 0x93d6}},
    {Format::astc_8x8_unorm, kNone, {}, {171, 172}, kKhrAstc, {0x93b7, 0x93d7}},
    {Format::astc_10x5_unorm, kNone, {}, {173, 174}, kKhrAstc, {0x93b8, 0x93d8}},
    {Format::astc_10x6_unorm, kNone, {}, {175, 176}, kKhrAstc, {0x93b9, 0x93d9}},
    {Format::astc_10x8_unorm, kNone, {}, {177, 178}, kKhrAstc, {0x93ba, 0x93da}},
    {Format::astc_10x10_unorm, kNone, {}, {179, 180}, kKhrAstc, {0x93bb, 0x93db}},
    {Format::astc_12x10_unorm, kNone, {}, {181, 182}, kKhrAstc, {0x93bc, 0x93dc}},
    {Format::astc_12x12_unorm, kNone, {}, {183, 184}, kKhrAstc, {0x93bd, 0x93dd}},
    {Format::r8_unorm, kL8, {61, 0, 60}, {9, 15}, kKhrRgbsda},
    {Format::rg8_unorm, kNone, {49, 0, 48}, {16, 22}, kKhrRgbsda},
    {Format::rgb8_unorm, kRgb8, {}, {23, 29}, kKhrRgbsda},
    {Format::rgba8_unorm, kRgba8, {28, 29, 27}, {37, 43}, kKhrRgbsda},
    {Format::r8_snorm, kNone, {63}, {10}, kKhrRgbsda},
    {Format::rg8_snorm, kNone, {51}, {17}, kKhrRgbsda},
    {Format::rgba8_snorm, kNone, {31}, {38}, kKhrRgbsda},
    {Format::r16_unorm, kL16, {56, 0, 53}, {70}, kKhrRgbsda},
    {Format::rg16_unorm, kNone, {35, 0, 33}, {77}, kKhrRgbsda},
    {Format::rgb16_unorm, kNone, {}, {84}, kKhrRgbsda},
    {Format::rgba16_unorm, coded(36), {11, 0, 9}, {91}, kKhrRgbsda},
    {Format::r16_snorm, kNone, {58}, {71}, kKhrRgbsda},
    {Format::rg16_snorm, kNone, {37}, {78}, kKhrRgbsda},
    {Format::rgba16_snorm, coded(110), {13}, {92}, kKhrRgbsda},
    {Format::r16_float, coded(111), {54}, {76}, kKhrRgbsda},
    {Format::rg16_float, coded(112), {34}, {83}, kKhrRgbsda},
    {Format::rgb16_float, kNone, {}, {90}, kKhrRgbsda},
    {Format::rgba16_float, coded(113), {10}, {97}, kKhrRgbsda},
    {Format::r32_float, coded(114), {41, 0, 39}, {100}, kKhrRgbsda},
    {Format::rg32_float, coded(115), {16, 0, 15}, {103}, kKhrRgbsda},
    {Format::rgb32_float, kNone, {6, 0, 5}, {106}, kKhrRgbsda},
    {Format::rgba32_float, coded(116), {2, 0, 1}, {109}, kKhrRgbsda},
};

static_assert([] {
    for (std::size_t k = 0; k < std::size(kMarks); ++k) {
        if (kMarks[k].format != static_cast<Format>(k)) return false;
    }
    return std::size(kMarks) == std::size(kFormatNames);
}());

}  // namespace

const FormatCodes& codes_of(Format format) { return kMarks[static_cast<std::size_t>(format)]; }

std::optional<MarkedFormat> find_format(FormatNumbers FormatCodes::*registry, std::uint32_t number) {
    for (const FormatCodes& row : kMarks) {
        const FormatNumbers& numbers = row.*registry;
        if (number == 0) break;
        if (number == numbers.exact || number == numbers.typeless) return MarkedFormat{row.format, false};
        if (number == numbers.srgb) return MarkedFormat{row.format, true};
    }
    return std::nullopt;
}

}  // namespace tex::inline v1
