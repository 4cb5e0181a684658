// SPDX-License-Identifier: Apache-2.0
// format.h: how a texture stores normals: formats, swizzles, encodings, textures.

#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <tex/types.h>

namespace tex::inline v1 {

// -- format --------------------------------------------------------------------------------------------------------
//
// How texels are stored: formats, swizzles, and the encodings of normal maps made of both.

// The layout of a level's bytes. Channels are in the order R, G, B, A, little-endian, rows from the top without
// padding. Block formats store rows of blocks from the top; blocks at the edges are stored whole. Blocks of BC1 to BC7
// and EAC have 4x4 texels, those of ASTC as many as the name says.
//
//   bc1   8 bytes a block: RGB, 5:6:5 endpoints (DXT1)             bc4   8 bytes: R, one BC4 block
//   bc2  16 bytes: 4-bit alpha, then a BC1 block (DXT3)            bc5  16 bytes: R and G, two BC4 blocks
//   bc3  16 bytes: alpha as a BC4 block, then a BC1 block (DXT5)
//
//   bc6h 16 bytes: RGB, half floats, unsigned or signed            bc7  16 bytes: RGBA
//
// BC6H is read, not written. Both: Khronos Data Format Specification, BPTC.
//
//   eac_r11   8 bytes: R, one EAC block of 11 bits              eac_rg11  16 bytes: R and G, two EAC blocks
//   astc     16 bytes: RGBA, low dynamic range (Khronos Data Format Specification, ASTC)
//
//   uastc    16 bytes: RGBA of 4x4 texels, low dynamic range; blocks of ASTC in another form (Basis Universal)
//   etc1s_rgb   8 bytes: RGB of 4x4 texels, one ETC1S block        etc1s_rgba  16 bytes: RGB, then A in the green of
//                                                                             a second ETC1S block
//
// ETC1S is read, not written. KTX2 stores ETC1S with BasisLZ, which is decoded to these blocks.
enum class Format {
    bc1_unorm,
    bc2_unorm,
    bc3_unorm,
    bc4_unorm,
    bc4_snorm,
    bc5_unorm,
    bc5_snorm,
    bc6h_ufloat,
    bc6h_sfloat,
    bc7_unorm,
    eac_r11_unorm,
    eac_r11_snorm,
    eac_rg11_unorm,
    eac_rg11_snorm,
    astc_4x4_unorm,
    astc_5x4_unorm,
    astc_5x5_unorm,
    astc_6x5_unorm,
    astc_6x6_unorm,
    astc_8x5_unorm,
    astc_8x6_unorm,
    astc_8x8_unorm,
    astc_10x5_unorm,
    astc_10x6_unorm,
    astc_10x8_unorm,
    astc_10x10_unorm,
    astc_12x10_unorm,
    astc_12x12_unorm,
    r8_unorm,
    rg8_unorm,
    rgb8_unorm,
    rgba8_unorm,
    r8_snorm,
    rg8_snorm,
    rgba8_snorm,
    r16_unorm,
    rg16_unorm,
    rgb16_unorm,
    rgba16_unorm,
    r16_snorm,
    rg16_snorm,
    rgba16_snorm,
    r16_float,
    rg16_float,
    rgb16_float,
    rgba16_float,
    r32_float,
    rg32_float,
    rgb32_float,
    rgba32_float,
    uastc_4x4_unorm,
    etc1s_rgb_unorm,
    etc1s_rgba_unorm,
};

inline constexpr Named<Format> kFormatNames[] = {
    {Format::bc1_unorm, "bc1-unorm", "BC1 (DXT1)"},
    {Format::bc2_unorm, "bc2-unorm", "BC2 (DXT3)"},
    {Format::bc3_unorm, "bc3-unorm", "BC3 (DXT5)"},
    {Format::bc4_unorm, "bc4-unorm", "BC4 (ATI1)"},
    {Format::bc4_snorm, "bc4-snorm", "BC4, signed"},
    {Format::bc5_unorm, "bc5-unorm", "BC5 (ATI2)"},
    {Format::bc5_snorm, "bc5-snorm", "BC5, signed"},
    {Format::bc6h_ufloat, "bc6h-ufloat", "BC6H, half"},
    {Format::bc6h_sfloat, "bc6h-sfloat", "BC6H, half, signed"},
    {Format::bc7_unorm, "bc7-unorm", "BC7"},
    {Format::eac_r11_unorm, "eac-r11-unorm", "EAC R11"},
    {Format::eac_r11_snorm, "eac-r11-snorm", "EAC R11, signed"},
    {Format::eac_rg11_unorm, "eac-rg11-unorm", "EAC RG11"},
    {Format::eac_rg11_snorm, "eac-rg11-snorm", "EAC RG11, signed"},
    {Format::astc_4x4_unorm, "astc-4x4-unorm", "ASTC, blocks of 4x4 texels"},
    {Format::astc_5x4_unorm, "astc-5x4-unorm", "ASTC, blocks of 5x4 texels"},
    {Format::astc_5x5_unorm, "astc-5x5-unorm", "ASTC, blocks of 5x5 texels"},
    {Format::astc_6x5_unorm, "astc-6x5-unorm", "ASTC, blocks of 6x5 texels"},
    {Format::astc_6x6_unorm, "astc-6x6-unorm", "ASTC, blocks of 6x6 texels"},
    {Format::astc_8x5_unorm, "astc-8x5-unorm", "ASTC, blocks of 8x5 texels"},
    {Format::astc_8x6_unorm, "astc-8x6-unorm", "ASTC, blocks of 8x6 texels"},
    {Format::astc_8x8_unorm, "astc-8x8-unorm", "ASTC, blocks of 8x8 texels"},
    {Format::astc_10x5_unorm, "astc-10x5-unorm", "ASTC, blocks of 10x5 texels"},
    {Format::astc_10x6_unorm, "astc-10x6-unorm", "ASTC, blocks of 10x6 texels"},
    {Format::astc_10x8_unorm, "astc-10x8-unorm", "ASTC, blocks of 10x8 texels"},
    {Format::astc_10x10_unorm, "astc-10x10-unorm", "ASTC, blocks of 10x10 texels"},
    {Format::astc_12x10_unorm, "astc-12x10-unorm", "ASTC, blocks of 12x10 texels"},
    {Format::astc_12x12_unorm, "astc-12x12-unorm", "ASTC, blocks of 12x12 texels"},
    {Format::r8_unorm, "r8-unorm", "8 bits"},
    {Format::rg8_unorm, "rg8-unorm", "2 x 8 bits"},
    {Format::rgb8_unorm, "rgb8-unorm", "3 x 8 bits"},
    {Format::rgba8_unorm, "rgba8-unorm", "4 x 8 bits"},
    {Format::r8_snorm, "r8-snorm", "8 bits, signed"},
    {Format::rg8_snorm, "rg8-snorm", "2 x 8 bits, signed"},
    {Format::rgba8_snorm, "rgba8-snorm", "4 x 8 bits, signed"},
    {Format::r16_unorm, "r16-unorm", "16 bits"},
    {Format::rg16_unorm, "rg16-unorm", "2 x 16 bits"},
    {Format::rgb16_unorm, "rgb16-unorm", "3 x 16 bits"},
    {Format::rgba16_unorm, "rgba16-unorm", "4 x 16 bits"},
    {Format::r16_snorm, "r16-snorm", "16 bits, signed"},
    {Format::rg16_snorm, "rg16-snorm", "2 x 16 bits, signed"},
    {Format::rgba16_snorm, "rgba16-snorm", "4 x 16 bits, signed"},
    {Format::r16_float, "r16-float", "half"},
    {Format::rg16_float, "rg16-float", "2 x half"},
    {Format::rgb16_float, "rgb16-float", "3 x half"},
    {Format::rgba16_float, "rgba16-float", "4 x half"},
    {Format::r32_float, "r32-float", "float"},
    {Format::rg32_float, "rg32-float", "2 x float"},
    {Format::rgb32_float, "rgb32-float", "3 x float"},
    {Format::rgba32_float, "rgba32-float", "4 x float"},
    {Format::uastc_4x4_unorm, "uastc-4x4-unorm", "UASTC, blocks of 4x4 texels"},
    {Format::etc1s_rgb_unorm, "etc1s-rgb-unorm", "ETC1S"},
    {Format::etc1s_rgba_unorm, "etc1s-rgba-unorm", "ETC1S with alpha"},
};

// What a Format consists of.
struct FormatInfo {
    SampleKind sample;        // unorm, snorm or floating
    int channels;             // 1 to 4, always the first of R, G, B, A
    int bits;                 // of a decoded sample: 8, 11 (EAC), 16 or 32
    Extent block;             // texels of a block; 1x1 if the format has no blocks
    std::size_t block_bytes;  // bytes of a block (of a texel if the format has no blocks)

    [[nodiscard]] bool has_blocks() const { return block != Extent{1, 1}; }
    friend bool operator==(const FormatInfo&, const FormatInfo&) = default;
};

[[nodiscard]] TEX_API FormatInfo format_info(Format format);

// The format without blocks for these samples; nullopt if there is none (no format has three signed channels).
[[nodiscard]] TEX_API std::optional<Format> format_of(SampleKind sample, int bits, int channels);

// Bytes of a level: blocks across times blocks down times bytes of a block. The numbers of blocks are rounded up. Does
// not overflow for extents up to kMaxExtent.
[[nodiscard]] TEX_API std::size_t level_bytes(Format format, Extent extent);

// What one stored channel holds.
enum class Component {
    zero,  // constant 0
    one,   // constant 1
    x,
    y,
    z,      // a component of the normal
    other,  // anything else (height, gloss, unused): no part of the normal; see NormalMap::blue and alpha
};

inline constexpr Named<Component> kComponentNames[] = {
    {Component::zero, "0", "constant 0"},   {Component::one, "1", "constant 1"},
    {Component::x, "x", "x of the normal"}, {Component::y, "y", "y of the normal"},
    {Component::z, "z", "z of the normal"}, {Component::other, "_", "something else"},
};

// What the stored channels R, G, B and A hold, in this order: DXT5nm is {one, y, one, x}. A format with fewer
// channels reads 0 for the missing colours and 1 for the missing alpha, as GPUs do: BC5 is {x, y, zero, one}.
using Swizzle = std::array<Component, 4>;

inline constexpr Swizzle kSwizzleXy = {Component::x, Component::y, Component::zero, Component::one};
inline constexpr Swizzle kSwizzleYx = {Component::y, Component::x, Component::zero, Component::one};
inline constexpr Swizzle kSwizzleXyz = {Component::x, Component::y, Component::z, Component::other};
inline constexpr Swizzle kSwizzleDxt5nm = {Component::one, Component::y, Component::one, Component::x};
inline constexpr Swizzle kSwizzleXxxy = {Component::x, Component::x, Component::x, Component::y};

// The names of the components (kComponentNames) in the order R, G, B, A, as four characters: "1y1x".
[[nodiscard]] TEX_API std::string to_string(const Swizzle& swizzle);

// The encodings of normal maps that pack() makes: a format and a swizzle.
//
//   unorm    code = floor((n + 1) / 2 * (2^k - 1) + 0.5), clamped     flat is (127.5, 127.5, 255) of 255: 128, 128, 255
//   snorm    code = round(n (2^(k-1) - 1)), halves away from zero     the lowest code is never written
//   float    n itself
enum class Encoding {
    dxt5nm,
    bc5,
    bc5_snorm,
    eac_rg11,
    eac_rg11_snorm,
    astc_4x4,
    astc_5x4,
    astc_5x5,
    astc_6x5,
    astc_6x6,
    astc_8x5,
    astc_8x6,
    astc_8x8,
    rgb8,
    rgba8,
    rgb16,
    ag8,
    rg8,
    rg16,
    half,
    float_,
    rgba16,
    rgba16f,
    rgba32f,
    bc7,
    uastc,
    uastc_rrrg,
    bc7_rxgb
};

inline constexpr Named<Encoding> kEncodingNames[] = {
    {Encoding::dxt5nm, "dxt5nm", "BC3, R = 1, G = y, B = 1, A = x"},
    {Encoding::bc5, "bc5", "BC5, x and y"},
    {Encoding::bc5_snorm, "bc5-snorm", "signed BC5, x and y"},
    {Encoding::eac_rg11, "eac-rg11", "EAC RG11, x and y with 11 bits each"},
    {Encoding::eac_rg11_snorm, "eac-rg11-snorm", "signed EAC RG11, x and y"},
    {Encoding::astc_4x4, "astc-4x4", "ASTC, 8 bits a texel, R = G = B = x, A = y"},
    {Encoding::astc_5x4, "astc-5x4", "ASTC, 6.4 bits a texel, R = G = B = x, A = y"},
    {Encoding::astc_5x5, "astc-5x5", "ASTC, 5.12 bits a texel, R = G = B = x, A = y"},
    {Encoding::astc_6x5, "astc-6x5", "ASTC, 4.27 bits a texel, R = G = B = x, A = y"},
    {Encoding::astc_6x6, "astc-6x6", "ASTC, 3.56 bits a texel, R = G = B = x, A = y"},
    {Encoding::astc_8x5, "astc-8x5", "ASTC, 3.2 bits a texel, R = G = B = x, A = y"},
    {Encoding::astc_8x6, "astc-8x6", "ASTC, 2.67 bits a texel, R = G = B = x, A = y"},
    {Encoding::astc_8x8, "astc-8x8", "ASTC, 2 bits a texel, R = G = B = x, A = y"},
    {Encoding::rgb8, "rgb8", "x, y, z with 8 bits each"},
    {Encoding::rgba8, "rgba8", "x, y, z and A = 1 with 8 bits each"},
    {Encoding::rgb16, "rgb16", "x, y, z with 16 bits each"},
    {Encoding::ag8, "ag8", "the layout of dxt5nm, uncompressed with 8 bits each"},
    {Encoding::rg8, "rg8", "x and y with 8 bits each"},
    {Encoding::rg16, "rg16", "x and y with 16 bits each"},
    {Encoding::half, "half", "x, y, z as 16-bit floats"},
    {Encoding::float_, "float", "x, y, z as 32-bit floats"},
    {Encoding::rgba16, "rgba16", "x, y, z and A = 1 with 16 bits each"},
    {Encoding::rgba16f, "rgba16f", "x, y, z and A = 1 as 16-bit floats"},
    {Encoding::rgba32f, "rgba32f", "x, y, z and A = 1 as 32-bit floats"},
    {Encoding::bc7, "bc7", "BC7, x, y, z and A = 1"},
    {Encoding::uastc, "uastc", "UASTC of Basis Universal, x, y, z and A = 1: glTF"},
    {Encoding::uastc_rrrg, "uastc-rrrg", "UASTC of Basis Universal, R = G = B = x, A = y: not glTF"},
    {Encoding::bc7_rxgb, "bc7-rxgb", "BC7, R = 1, G = y, B = z, A = x: Doom 3"},
};

struct EncodingInfo {
    Format format;
    Swizzle swizzle;
};

[[nodiscard]] TEX_API EncodingInfo encoding_info(Encoding encoding);

// What an encoding can hold beside normals: blue in the place of z, alpha in the place of a constant, and data in the
// length of vectors whose z is stored; so blue and length exclude each other. Of encodings with blocks, only bc7 can
// hold any: alpha.
[[nodiscard]] TEX_API ExtraSet can_hold(Encoding encoding);

// Whether pack() can choose blocks of this encoding that compress better (RdoOptions): if it has blocks.
[[nodiscard]] TEX_API bool can_optimise(Encoding encoding);

// The slope from which on all slopes are stored alike. Without z: the component rounds to 1, so that the surface
// becomes vertical; 11.3 for 8 bits, 32 for the 11 bits of EAC, 181 for 16 bits. With z: z rounds to its least positive
// code; 127 and 32767. Infinite for half and float.
[[nodiscard]] TEX_API float steepest_slope(Encoding encoding);

// -- texture -------------------------------------------------------------------------------------------------------
//
// A packed texture: the bytes of its levels and their meaning.

// One level: exactly level_bytes(format, extent) bytes in the layout of the format.
struct Level {
    Extent extent;
    std::vector<std::byte> bytes;
};

// A texture between pack() and a file, or between a file and unpack(). levels[0] is the base level; the others have the
// extents of level_extent().
struct Texture {
    Format format = Format::rgba8_unorm;
    std::vector<Level> levels;

    // What the channels hold, and the direction of y. If a file does not state them, the reader leaves `swizzle_known`
    // or `y_known` false, and the value is the likeliest for the file's format. A format of one channel has it in R;
    // if that channel is alpha (DDPF_ALPHA, DXGI_FORMAT_A8_UNORM), the swizzle is 000_.
    Swizzle swizzle = kSwizzleXyz;
    bool swizzle_known = false;
    // BC5 of which the file does not say whether x or y comes first (DDS with the FourCC ATI2 and no code).
    // guess_swizzle() looks at the texels.
    bool order_open = false;
    YAxis y_axis = YAxis::up;
    bool y_known = false;

    // Where R, G and B are equal and A varies, they hold x and A holds y: the convention of ASTC and KTX2 (Khronos'
    // texture tools, --normal-mode). Elsewhere such texels are DXT5nm. guess_swizzle() asks for it.
    bool x_in_grey = false;

    // Image::normal_encoding of its levels: "signed" if floats are the components of normals themselves, or empty.
    std::string normal_encoding;

    // The file declares its colours as sRGB. That is a mistake for normals; the bytes are used as they are.
    bool srgb = false;

    // The file is KTX2 whose levels are compressed with zlib, which few programs but Khronos' own inflate.
    bool zlib = false;

    // For heights: the strengths with which bake() makes the normals again from which they were integrated. 0: not
    // known.
    float bumpiness_x = 0.0f, bumpiness_y = 0.0f;

    // The orientation that the file states, 1 to 8, as in TIFF and EXIF, and whether the texels have been turned
    // accordingly: those of PNG are not. The vectors in them are as they are stored.
    int orientation = 1;
    bool turned = true;

    // Bytes beyond the levels, which were not read: after the last one, and in KTX2 between them, too.
    std::uint64_t trailing_bytes = 0;

    // Other faults that the reader ignored ("mip count says 3, the data end after 2"), one sentence each.
    std::vector<std::string> remarks;

    [[nodiscard]] Extent extent() const { return levels.empty() ? Extent{} : levels.front().extent; }
};

// -- swizzle -------------------------------------------------------------------------------------------------------
//
// The names of the layouts of normal maps, and how the layout of a texture is found.

inline constexpr Named<Swizzle> kSwizzleNames[] = {
    {kSwizzleXyz, "rgb", "x, y, z in R, G, B"},
    {kSwizzleDxt5nm, "dxt5nm", "x in A, y in G (Unity; also xGxR, AG)"},
    {{Component::other, Component::y, Component::z, Component::x}, "rxgb", "x in A, y in G, z in B (Doom 3)"},
    {kSwizzleXy, "rg", "x in R, y in G"},
    {kSwizzleYx, "gr", "y in R, x in G (3Dc)"},
    {{Component::z, Component::y, Component::x, Component::other}, "bgr", "z, y, x in R, G, B"},
    {kSwizzleXxxy, "ra", "x in R, G and B, y in A (ASTC)"},
};

// The name in kSwizzleNames of the layout with x, y and z in the same channels as in `swizzle`; if there is none, the
// letters of to_string(). Files, reports and messages name a layout by this word.
[[nodiscard]] TEX_API std::string layout_name(const Swizzle& swizzle);

// Finds the channels of `texture` that hold the normal. This is its own swizzle if the file states it or if the format
// leaves no choice (fewer than four channels). If Texture::order_open is set, it is the order of x and y in which the
// slopes of the base level have no curl, or x first if they do not show it clearly. Otherwise the texels of the base
// level decide, up to about 2^20 of them, spread over the map:
//
//   ra       in ASTC and KTX2 (Texture::x_in_grey), R, G and B are equal (x in all three), and A is not 1 everywhere
//   rgb      R and B are constant (within 8/255), and those of a flat map (x = 0, z = 1): A is something else
//   dxt5nm   R and B are constant otherwise, and A varies or R, G, B cannot be a unit vector (if they are floats:
//            neither unchanged nor as (n + 1) / 2); or A varies and R, G and B are equal (y in all three)
//   rxgb     R is constant, A is not, and A, G, B are nearer to unit vectors than R, G, B
//   rgb      all others
//
// A texture without x or y in its own swizzle (one channel) keeps it; unpack() then reports what is missing.
//
// Errors: as decode() of the base level. The same result for every number of threads.
[[nodiscard]] TEX_API Result<Swizzle> guess_swizzle(const Texture& texture, const Execution& execution = {});

}  // namespace tex::inline v1
