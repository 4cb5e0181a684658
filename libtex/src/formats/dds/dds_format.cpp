// SPDX-License-Identifier: Apache-2.0

#include "formats/dds/dds_format.h"

#include <algorithm>
#include <string_view>

#include "formats/bytes.h"
#include "formats/channels.h"
#include "formats/dds/dds_refused.h"
#include "rows/codecs.h"

namespace tex::inline v1 {
namespace {

constexpr Component kX = Component::x;
constexpr Component kY = Component::y;
constexpr Component kZ = Component::z;
constexpr Component kNone = Component::other;

// A FourCC, or the number of a D3DFORMAT in its place. `swizzle` is all zero if the code does not state one.
struct FourCcRow {
    std::uint32_t code;
    Format format;
    bool swizzle_known;
    Swizzle swizzle;
};

constexpr FourCcRow kFourCcs[] = {
    {fourcc("DXT1"), Format::bc1_unorm, false, {}},
    {fourcc("DXT2"), Format::bc2_unorm, false, {}},
    {fourcc("DXT3"), Format::bc2_unorm, false, {}},
    {fourcc("DXT4"), Format::bc3_unorm, false, {}},
    {fourcc("DXT5"), Format::bc3_unorm, false, {}},
    // id Software's format: red was moved to alpha, and blue was kept.
    {fourcc("RXGB"), Format::bc3_unorm, true, {kNone, kY, kZ, kX}},
    {fourcc("A2D5"), Format::bc3_unorm, true, {kNone, kY, kNone, kX}},
    {fourcc("ATI1"), Format::bc4_unorm, false, {}},
    {fourcc("BC4U"), Format::bc4_unorm, false, {}},
    {fourcc("BC4S"), Format::bc4_snorm, false, {}},
    // 3Dc (ATI 2005) holds y first; most tools wrote x first under the same name.
    {fourcc("ATI2"), Format::bc5_unorm, false, kSwizzleXy},
    {fourcc("A2XY"), Format::bc5_unorm, true, kSwizzleXy},
    {fourcc("BC5U"), Format::bc5_unorm, false, {}},
    {fourcc("BC5S"), Format::bc5_snorm, false, {}},
    {36, Format::rgba16_unorm, false, {}},   // D3DFMT_A16B16G16R16
    {110, Format::rgba16_snorm, false, {}},  // D3DFMT_Q16W16V16U16
    {111, Format::r16_float, false, {}},
    {112, Format::rg16_float, false, {}},
    {113, Format::rgba16_float, false, {}},
    {114, Format::r32_float, false, {}},
    {115, Format::rg32_float, false, {}},
    {116, Format::rgba32_float, false, {}},
    {117, Format::rg8_snorm, false, {}},  // D3DFMT_CxV8U8: z is computed
};

// DXGI formats of bit fields.
struct DxgiFieldsRow {
    std::uint32_t dxgi;
    FieldLayout layout;
    bool srgb = false;
};

constexpr DxgiFieldsRow kDxgiFields[] = {
    {23, {4, {0x3ff, 0xffc00, 0x3ff00000, 0xc0000000}}},  // R10G10B10A2, typeless
    {24, {4, {0x3ff, 0xffc00, 0x3ff00000, 0xc0000000}}},
    {65, {1, {0, 0, 0, 0xff}}},                       // A8
    {85, {2, {0xf800, 0x7e0, 0x1f, 0}}},              // B5G6R5
    {86, {2, {0x7c00, 0x3e0, 0x1f, 0x8000}}},         // B5G5R5A1
    {87, {4, {0xff0000, 0xff00, 0xff, 0xff000000}}},  // B8G8R8A8
    {90, {4, {0xff0000, 0xff00, 0xff, 0xff000000}}},
    {91, {4, {0xff0000, 0xff00, 0xff, 0xff000000}}, true},
    {88, {4, {0xff0000, 0xff00, 0xff, 0}}},  // B8G8R8X8
    {92, {4, {0xff0000, 0xff00, 0xff, 0}}},
    {93, {4, {0xff0000, 0xff00, 0xff, 0}}, true},
    {115, {2, {0xf00, 0xf0, 0xf, 0xf000}}},  // B4G4R4A4
};

bool is_printable(std::uint32_t code) {
    for (int shift = 0; shift < 32; shift += 8) {
        const std::uint32_t c = code >> shift & 0xff;
        if (c < 0x20 || c > 0x7e) return false;
    }
    return true;
}

// A code as its four letters, or as a number if they are not printable.
std::string code_text(std::uint32_t code) {
    if (!is_printable(code)) return std::to_string(code);
    std::string text = "'";
    for (int shift = 0; shift < 32; shift += 8) text += static_cast<char>(code >> shift & 0xff);
    return text + "'";
}

// The swizzle codes that ATI's Compressonator and NVIDIA's tools write. 'A2XY' and 'A2D5' are names. The others state
// letter by letter which original colour is in R, G, B and A, with x for none: in xGxR, alpha holds red, which is the
// normal's x.
std::optional<Swizzle> swizzle_of_code(std::uint32_t code) {
    if (code == fourcc("A2XY")) return kSwizzleXy;
    if (code == fourcc("A2D5")) return Swizzle{kNone, kY, kNone, kX};
    Swizzle swizzle;
    for (std::size_t c = 0; c < 4; ++c) {
        switch (code >> (8 * c) & 0xff) {
            case 'R': swizzle[c] = kX; break;
            case 'G': swizzle[c] = kY; break;
            case 'B': swizzle[c] = kZ; break;
            case 'A':
            case 'x': swizzle[c] = kNone; break;
            default: return std::nullopt;
        }
    }
    const auto holds = [&](Component component) { return std::count(swizzle.begin(), swizzle.end(), component) == 1; };
    if (!holds(kX) || !holds(kY)) return std::nullopt;
    return swizzle;
}

DdsTexels texels_in(Format format) {
    DdsTexels texels;
    texels.format = format;
    texels.swizzle = likely_swizzle(format);
    return texels;
}

Result<DdsTexels> texels_of_fields(FieldLayout layout) {
    const auto& [red, green, blue, alpha] = layout.fields;
    const bool alpha_alone = red == 0 && green == 0 && blue == 0 && alpha != 0;
    if (alpha_alone) layout.fields = {alpha, 0, 0, 0};  // a format of one channel; the swizzle states that it is alpha
    const std::optional<Format> format = format_of(layout);
    if (!format) return Error{ErrorCode::bad_data, {}, "the channel masks of the pixel format make no sense"};
    DdsTexels texels = texels_in(*format);
    if (alpha_alone) texels.swizzle = kAlphaAlone;
    texels.fields = layout;
    return texels;
}

std::optional<DdsTexels> texels_of_four_cc(const DdsPixelFormat& pixel_format) {
    std::uint32_t code = pixel_format.four_cc;
    // Some tools write the swizzle code in place of the FourCC: the format is then BC3.
    const std::optional<Swizzle> in_place = swizzle_of_code(code);
    for (const FourCcRow& row : kFourCcs) {
        if (row.code != code) continue;
        DdsTexels texels = texels_in(row.format);
        if (row.swizzle != Swizzle{}) texels.swizzle = row.swizzle;
        texels.swizzle_known = row.swizzle_known;
        if (code == fourcc("DXT2") || code == fourcc("DXT4")) {
            texels.remarks.push_back(code_text(code) +
                                     " declares colours multiplied by alpha; they are used as they are");
        }
        const bool codable = row.format == Format::bc3_unorm || row.format == Format::bc5_unorm;
        if (const auto swizzle = swizzle_of_code(pixel_format.bit_count); codable && swizzle) {
            texels.swizzle = *swizzle;
            texels.swizzle_known = true;
        } else if (pixel_format.bit_count > 128) {
            texels.remarks.push_back("unknown swizzle code " + code_text(pixel_format.bit_count));
        } else if (row.format == Format::bc3_unorm && !row.swizzle_known && (pixel_format.flags & kDdpfNormal) != 0) {
            texels.swizzle = {kNone, kY, kNone, kX};
            texels.swizzle_known = true;
        }
        texels.order_open = code == fourcc("ATI2") && !texels.swizzle_known;
        return texels;
    }
    if (!in_place) return std::nullopt;
    DdsTexels texels = texels_in(Format::bc3_unorm);
    texels.swizzle = *in_place;
    texels.swizzle_known = true;
    return texels;
}

Result<DdsTexels> texels_of_masks(const DdsPixelFormat& pixel_format) {
    const std::uint32_t bits = pixel_format.bit_count;
    if (bits != 8 && bits != 16 && bits != 24 && bits != 32) {
        return Error{ErrorCode::bad_data, {}, "texels of " + std::to_string(bits) + " bits"};
    }
    const std::uint32_t flags = pixel_format.flags;
    const std::array<std::uint32_t, 4>& masks = pixel_format.masks;
    FieldLayout layout;
    layout.texel_bytes = static_cast<int>(bits / 8);
    const std::uint32_t alpha = (flags & kDdpfAlphaPixels) != 0 ? masks[3] : 0;
    if ((flags & kDdpfRgb) != 0) {
        layout.fields = {masks[0], masks[1], masks[2], alpha};
    } else if ((flags & kDdpfLuminance) != 0) {
        layout.fields = {masks[0], 0, 0, 0};
        if (alpha != 0) layout.fields = {masks[0], masks[0], masks[0], alpha};
    } else if ((flags & kDdpfBumpDudv) != 0) {
        layout.fields = masks;
        layout.snorm = true;
    } else {
        layout.fields = {0, 0, 0, masks[3]};
    }
    return texels_of_fields(layout);
}

}  // namespace

Result<DdsTexels> texels_of(const DdsPixelFormat& pixel_format) {
    constexpr std::uint32_t kMasked = kDdpfAlpha | kDdpfRgb | kDdpfLuminance | kDdpfBumpDudv;
    const bool masked = (pixel_format.flags & kMasked) != 0;
    const bool coded = (pixel_format.flags & kDdpfFourCc) != 0;
    if (coded || !masked) {
        if (auto texels = texels_of_four_cc(pixel_format)) {
            if (!coded) texels->remarks.push_back("the pixel format's flags are missing");
            return std::move(*texels);
        }
    }
    std::string reason = refused_legacy(pixel_format);
    if (reason.empty() && masked) return texels_of_masks(pixel_format);
    if (reason.empty()) reason = "the pixel format " + code_text(pixel_format.four_cc) + " is not supported";
    return Error{ErrorCode::unsupported, {}, reason};
}

Result<DdsTexels> texels_of_dxgi(std::uint32_t dxgi) {
    if (const auto marked = find_format(&FormatRow::dxgi, dxgi)) {
        DdsTexels texels = texels_in(marked->format);
        texels.srgb = marked->srgb;
        return texels;
    }
    for (const DxgiFieldsRow& row : kDxgiFields) {
        if (row.dxgi != dxgi) continue;
        Result<DdsTexels> texels = texels_of_fields(row.layout);
        if (texels) texels->srgb = row.srgb;
        return texels;
    }
    return Error{ErrorCode::unsupported, {}, refused_dxgi(dxgi)};
}

}  // namespace tex::inline v1
