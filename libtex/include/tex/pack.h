// SPDX-License-Identifier: Apache-2.0
// pack.h: normals become textures, and textures normals.

#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include <tex/format.h>
#include <tex/mip.h>
#include <tex/types.h>

namespace tex::inline v1 {

// -- pack ----------------------------------------------------------------------------------------------------------
//
// Normals to the bytes of a texture.

// How hard the block encoders search for the smallest error (encodings without blocks are exact). In dxt5nm, bc5 and
// bc5_snorm:
//
//   best     no block could have a smaller squared error. This is exact if all values are whole codes, as those of
//            8-bit sources are in dxt5nm and bc5. Others are first rounded to 1/1024 of a code, so that the root mean
//            square error of a block is at most 1/900 of a code above the smallest one
//   normal   no channel of a block has a larger squared error than a plain fit, which puts the endpoints at the
//            extremes and refines them twice by linear least squares; halves are rounded up. This holds if all values
//            of the block are whole codes. Others are first rounded to 1/128 of a code, and about one block in 1000
//            has a larger error than a plain fit of the rounded values: texels and endpoints in the middle
//            between two codes are not always rounded up. Three or more values that lie on a palette with spacings of
//            at least 4/3 codes, as those of blocks that were decoded earlier do, are encoded to the same values
//            within 1/10 of a code
//   fast     refines once and does not check the result. The root mean square error of a block may exceed that of the
//            palette between the extremes, before rounding, by the effect of rounding: half a code (of 255) in BC4
//            blocks, or one code if their range is smaller; 2.8 codes in dxt5nm's green (whose palette leaves 1/16 of
//            the range at both ends); and 1/400 of the range
//
// EAC: values are rounded to 1/128 of a code of 11 bits; best is exact for these. normal scores palettes around the
// middle of the block's range, with the multipliers that suit the range, of all tables.
//
// ASTC: a block can be stored in hundreds of ways (grid and levels of weights, one plane or two, one to three
// partitions). The squared error of x and y in each is guessed; the block is fitted to those that seem best, and the
// least error, as decoders make it, decides. fast fits one way; normal six, and up to eight with several partitions if
// the squared error of a texel is greater than 1 (in codes of 255); best 32, and up to 76 with several partitions, of
// which it improves the best six. Blocks of one colour are exact within 1/4096.
//
// BC7: only the direction of a vector counts, since shaders normalise it. The error of a texel is the squared chord
// between the normal and the normalised x, y and z, and where alpha holds data, 4 times the squared error of alpha, so
// that a code of alpha counts as much as one of x. Each block is guessed in all modes: two planes, of which one holds
// x, y or z alone; one line; two or three lines. It is fitted to those that seem best, and the least error, as decoders
// make it, decides. fast fits up to four ways; normal 11, and improves the best two; best 39, and improves the best
// 12. Without data, alpha is 255 in every texel. With x in alpha (bc7_rxgb), red is 255, and only modes with alpha are
// tried.
//
// UASTC: the error is that of BC7, without alpha, and so is the search, in the modes of RGB: two planes, of which one
// holds x, y or z alone; one line; two or three lines. Hints say how transcoders make blocks of ETC1 and BC1 from a
// block: those are chosen whose blocks have the least error of direction. Of x and y alone (uastc_rrrg), the error is
// that of the normal that follows from both, in the modes of luminance and alpha: two planes; one line; two lines.
enum class Effort { fast, normal, best };

inline constexpr Named<Effort> kEffortNames[] = {
    {Effort::fast, "fast", "for previews and iteration"},
    {Effort::normal, "normal", "close to the optimum"},
    {Effort::best, "best", "the least squared error"},
};

// The error that Effort::best minimises; the other efforts, EAC and ASTC ignore it: component. BC7 and UASTC: angle,
// always.
enum class Metric { component, angle };

// component: the squared error of each channel on its own; no block could have a smaller one.
//
// angle: the sum of the squared chords between the normals (2 - 2 cos of the angle, for small angles its square). It
// starts from the blocks of component, takes the best pair of values for each texel, and moves the endpoints while any
// step of up to 3 codes, of one endpoint or of both endpoints of a channel, reduces the sum. No block has a larger sum
// than before; that none could have a smaller one is not proved. On the 18 maps of encode_bench the mean angle falls by
// 4 % and the 99.9th percentile by 12 %, most on steep maps. It encodes about a third as many texels a second as
// component.
inline constexpr Named<Metric> kMetricNames[] = {
    {Metric::component, "component", "the squared error of each channel"},
    {Metric::angle, "angle", "the angle between normals, much slower"},
};

// Rate-distortion optimisation: blocks that compress better, at a promised angle. Games store textures compressed
// (zstd, LZ4, deflate), so a file gets smaller if its blocks repeat bytes of earlier blocks. The encoder may replace a
// block by one that copies the indices, and perhaps the endpoints, of blocks shortly before it (ASTC: all but the
// weights, or all; BC7 and UASTC: all but the indices, or all), and takes that with the least D + lambda R (Sullivan
// and Wiegand, 1998): D is the sum of the angles of its texels, R its estimated size as matches and literals of a
// Lempel-Ziv coder.
//
// It applies where can_optimise() says so; others ignore it. A level is divided into bands of whole rows of blocks: the
// power of two that gives a band of the base level at least 16384 blocks and 64 rows of texels. Memory holds a few of
// them, and the bytes are the same for every number of threads. Each level is also divided into squares of 512x512
// texels, from the upper left corner; a rest of less than 64 texels belongs to the square beside it. What a square has
// in a band, its part, has its own lambda, the greatest one found that keeps the promise.
//
// The promise concerns the angles between the normals of the source and those of the blocks, as compare() measures
// them: on both sides, z = sqrt(1 - x^2 - y^2), or 0 where x^2 + y^2 is above 1, and then the vector is made unit. In
// BC7 and UASTC of x, y and z, they are between the directions of all three components. Where alpha of BC7 holds data,
// texels are vectors of four components, the last one twice alpha, and their angles those that have chords of this
// length: an error of one code of alpha, or of x, is 0.45 degrees.
//
//   mean     the mean angle of every part, so of every square and level, exceeds that of the same encoding without
//            optimisation by at most so many degrees
//   max      no texel's angle exceeds both `max` degrees and its own angle without optimisation; if `max` is 0, it is
//            kRdoMaxOfMean times the mean angle that the part may have, so that smooth maps stay smooth
//
// A band that cannot keep the promise, or is no smaller after zstd -19, stays plain; in files, so does a whole level.
inline constexpr int kLeastRdoWindow = 64;
inline constexpr int kMostRdoWindow = 1 << 20;
inline constexpr double kRdoMaxOfMean = 4.0;

struct RdoOptions {
    float mean = 0.0f;   // degrees, at least 0; 0: no optimisation
    float max = 0.0f;    // degrees, at least 0; 0: in proportion to the mean, as above; 180: no limit
    int window = 65536;  // bytes from a block back to what it may copy, in these bounds; time grows with it
};

// What optimisation has done, in degrees, in all levels together.
struct RdoReport {
    double plain_mean = 0.0;   // the mean angle without optimisation
    double mean = 0.0;         // the mean angle of the blocks
    double most_growth = 0.0;  // the greatest growth of a part's mean angle: at most RdoOptions::mean
    double most_raised = 0.0;  // the greatest angle of the texels whose angles have grown: at most `max`
};

struct PackOptions {
    Encoding encoding = Encoding::dxt5nm;
    YAxis y_axis = YAxis::up;  // of the texture; down stores -y
    Effort effort = Effort::normal;
    Metric metric = Metric::component;
    bool y_known = true;  // whether the texture states y_axis; false if that is only an assumption about the source
    RdoOptions rdo = {};
};

// Whether every option is in its range. The verbs call it first. Errors: bad_option, which names the option.
[[nodiscard]] TEX_API Result<void> validate(const PackOptions& options);

// A texture, and what the optimisation of its blocks has done: zeros without PackOptions::rdo.
struct PackedTexture : Texture {
    RdoReport rdo;
};

// Packs every level of a chain.
//
// Quantisation is described at Encoding (format.h), bc7 and uastc at Effort. Other 4x4 blocks: each channel is fitted
// on its own (x in BC3's alpha or the first block of BC5 and RG11, y in the green of BC3's colour block or their second
// block). If an extent is not a multiple of 4, texels outside repeat the last one and have no weight. In dxt5nm, R and
// B are 1 in both endpoints of every block, so that every decoder returns exactly 255. A flat block decodes to 127 or
// 128 in G and A under the rules of AMD, Intel and NVIDIA, within 0.23 degrees of (0, 0, 1).
//
// PackOptions::rdo optimises blocks for compression. PackedTexture::rdo says what that has done.
//
// Precondition: components are finite.
// Errors: bad_option (the chain has no level, or levels of other extents than those of level_extent(), or both blue and
//         length; as validate(options)), out_of_memory, cancelled
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] TEX_API Result<PackedTexture> pack(const MipChain& chain, const PackOptions& options = {},
                                                 const Execution& execution = {});

// The block encoders alone, for engines with their own memory and threads. Encodes x and y of a level, or of whole rows
// of its blocks.
//
// Rows need no padding and may have any stride. Row r of blocks (texel rows 4 r to 4 r + 3) starts at blocks + r *
// pitch; its block b (texel columns 4 b to 4 b + 3) starts 16 b bytes later. There are (height + 3) / 4 rows of (width
// + 3) / 4 blocks. The 16 bytes of a block are
//
//     dxt5nm            0 to 7: x, as BC3's alpha (BC4's layout); 8 to 15: y in the green of BC3's colours
//     bc5, bc5_snorm    0 to 7: x; 8 to 15: y; both in BC4's layout
//     eac_rg11, eac_rg11_snorm    0 to 7: x; 8 to 15: y; both in EAC's layout (R11)
//
// BC4's layout is two endpoints of 8 bits, then 16 indices of 3 bits, texel 0 in the lowest bits, little-endian. BC3's
// colours are two of 5, 6 and 5 bits, red highest, then 16 indices of 2 bits (Direct3D 11.3 Functional Specification,
// 19.5). Bytes and errors match those of pack() without optimisation; PackOptions::rdo, which needs many rows of
// blocks at once, is ignored.
//
// Precondition: components are finite. Errors: bad_option (x and y have not the same extent, at least 1x1; the encoding
// is not one of the five; pitch is less than 16 bytes for each block of a row). Unless it fails, it allocates no
// memory, and it starts no threads: different rows of blocks may be encoded at the same time.
[[nodiscard]] TEX_API Result<void> encode_blocks(PlaneView<const float> x, PlaneView<const float> y,
                                                 const PackOptions& options, std::byte* blocks, std::size_t pitch);

// -- unpack --------------------------------------------------------------------------------------------------------
//
// The bytes of a texture, or a picture, to normals.

// How stored floats are read. (Integers are unambiguous, except with z01: unorm is unsigned, snorm is signed.)
enum class ValueRange {
    automatic,  // as the file states; else by the values, see unpack()
    signed_,    // components of the normal themselves
    unsigned_,  // (n + 1) / 2
    // x and y as they would be otherwise, z itself, from 0 to 1. Floats are then unsigned. Some exporters write this
    // (glTF-Sample-Models, issue 364); integers, too.
    z01,
};

inline constexpr Named<ValueRange> kValueRangeNames[] = {
    {ValueRange::automatic, "auto", "as the file says, else by the values"},
    {ValueRange::signed_, "signed", "floats are the normal's components, -1 to 1"},
    {ValueRange::unsigned_, "unsigned", "floats are (n + 1) / 2, 0 to 1"},
    {ValueRange::z01, "z01", "z is stored as it is, 0 to 1, x and y as (n + 1) / 2"},
};

struct UnpackOptions {
    std::optional<Swizzle> swizzle;            // instead of the texture's own
    std::optional<YAxis> y_axis;               // instead of the texture's own; without it, y is up in pictures
    ValueRange range = ValueRange::automatic;  // for floats only, but for z01
    bool snap_flat = false;                    // 8-bit unorm values from 127/255 to 128/255 are 0, not -+0.0039
    bool keep_length = false;                  // do not normalise vectors, to pack them again without loss
    bool keep_invalid = false;                 // vectors that are not finite become NaN, not (0, 0, 1)
    // Which data beside the normals go along: NormalMap::blue is B as it is stored, if it holds no part of the normals,
    // and so is NormalMap::alpha, unless it is 1 everywhere; NormalMap::length is what the lengths of vectors hold, if
    // z is stored. Lengths are data only if this says so.
    ExtraSet others = {false, true, false};

    friend bool operator==(const UnpackOptions&, const UnpackOptions&) = default;
};

// Decodes one level to float planes, one for each channel of the format, named R, G, B, A (only A if the swizzle states
// that the only channel is alpha): [0, 1] for unorm, [-1, 1] for snorm, unchanged for floats. Block formats decode by
// these rules, not by those of a particular GPU: 5- and 6-bit endpoints are widened to 8 bits by bit replication,
// palettes interpolate with exact thirds, fifths and sevenths, and nothing is rounded. The lowest snorm code is -1 too.
//
// Errors: bad_option (there is no such level, or it does not have level_bytes() bytes), out_of_memory, cancelled.
[[nodiscard]] TEX_API Result<Image> decode(const Texture& texture, int level, const Execution& execution = {});

// The decoders alone, for engines with their own memory and threads: rows of texels or of blocks of any format, as
// decode() decodes them. Row r of blocks (or of texels, in formats without blocks) starts at bytes + r * pitch. Channel
// c of the format goes to channels[c], or nowhere if its `data` is null; rows need no padding. Any bytes decode.
//
// Errors: bad_option (the channels that are wanted have not the same extent and stride, or one is not of the format;
// pitch is less than level_bytes() of one row of texels). Unless it fails, it allocates no memory, and it starts no
// threads.
[[nodiscard]] TEX_API Result<void> decode_blocks(Format format, const std::byte* bytes, std::size_t pitch,
                                                 const std::array<PlaneView<float>, 4>& channels);

// The normals of every level of a texture. unorm values become n = 2 c - 1; y is negated if it points down in the
// texture. If the swizzle holds z, vectors are normalised (shorter than 1e-6: (0, 0, 1); z below 0: as stored). If it
// holds only x and y, z = reconstruct_z(x, y); if x^2 + y^2 is above 1, x and y are divided by their length, so that
// the vector has unit length. A vector that is not finite, or whose squared length is not, becomes (0, 0, 1), or NaN
// with UnpackOptions::keep_invalid (integrate() and curvature() take such maps). 32-bit floats whose vector already has
// unit length (x^2 + y^2 + z^2 within 2^-20 of 1) are unchanged, so that several commands in a row give the same bytes
// as one.
//
// Floats in ValueRange::automatic are read as Texture::normal_encoding states ("signed" or "unsigned"). If it is empty,
// the base level decides for all levels. They are signed if a value of x, y or z is below 0, or if that reading is
// nearer to unit vectors by the sum of |x^2 + y^2 + z^2 - 1| (without z, of max(0, x^2 + y^2 - 1)). Otherwise they are
// unsigned.
//
// If several channels of the swizzle hold a component, it is read from the first of them.
//
// Errors: bad_option  the swizzle lacks x or y, or has one of them in a channel that the format lacks; there is no
//                     level, or one without the extent of level_extent() or level_bytes() bytes
//         out_of_memory, cancelled
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] TEX_API Result<MipChain> unpack(const Texture& texture, const UnpackOptions& options = {},
                                              const Execution& execution = {});

// The normals of a picture. The swizzle names planes: R, G, B, A. In a picture with planes of other names, R, G and B
// are the planes red, green and blue, or X, Y and Z, or U and V, in any case and after the name of a layer ("N.R",
// "ViewLayer.Normal.X"). If several layers have them, it is those without a layer, or else those of the layer called
// normal. In a picture without any of these, the plane Y is used for R, G and B; without Y, the planes are R, G, B, A
// in their order. Without a swizzle in the options, x, y and z are R, G and B, or the two planes of a picture are x and
// y. ValueRange::automatic: by Image::normal_encoding, else as above. Errors: also bad_option if it is not clear which
// layer holds the normals.
[[nodiscard]] TEX_API Result<NormalMap> unpack(const Image& image, const UnpackOptions& options = {},
                                               const Execution& execution = {});

// -- roughness ------------------------------------------------------------------------------------------------------

// What a channel of a roughness file holds. `smoothness` is 1 - roughness. `kept`: what RoughnessFile::kept has there,
// averaged in smaller levels that it lacks; 1 if it has no such channel.
enum class RoughnessPart { roughness, smoothness, zero, one, kept };

using RoughnessParts = std::array<RoughnessPart, 4>;  // of R, G, B and A, as far as the format has them

// The first channel holds roughness; no channel holds a component of a normal.
inline constexpr Swizzle kRoughnessSwizzle = {Component::other, Component::zero, Component::zero, Component::one};

// Packs a chain as a texture of one channel: bc4_unorm or eac_r11_unorm (with the guarantees of pack()), the formats of
// ASTC from 4x4 to 8x8 (as luminance: R = G = B), uastc_4x4_unorm (R = G = B, with the least squared error of codes;
// any KTX2 loader of Basis Universal makes of it what its GPU reads), r8_unorm, r16_unorm (codes rounded as in
// format.h, of the value instead of (n + 1) / 2), r16_float or r32_float. Other formats give bad_option.
//
// Errors: bad_option, out_of_memory, cancelled.
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] TEX_API Result<Texture> pack_roughness(const RoughnessChain& chain, Format format = Format::r8_unorm,
                                                     Effort effort = Effort::normal, const Execution& execution = {});

}  // namespace tex::inline v1
