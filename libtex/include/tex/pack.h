// SPDX-License-Identifier: Apache-2.0
// pack.h: normals to the bytes of a texture.

#pragma once

#include <cstddef>

#include <tex/execution.h>
#include <tex/image.h>
#include <tex/mip_chain.h>
#include <tex/names.h>
#include <tex/result.h>
#include <tex/texture.h>

#pragma GCC visibility push(default)
namespace tex {

// How hard the block encoders search for the smallest error (dxt5nm, bc5 and bc5_snorm; the others are exact).
//
//   best     no block could have a smaller squared error. This is exact if all values are whole codes, as those of
//            8-bit sources are in dxt5nm and bc5. Others are first rounded to 1/1024 of a code, so that the root mean
//            square error of a block is at most 1/900 of a code above the smallest one
//   normal   no channel of a block has a larger squared error than a plain fit, which puts the endpoints at the
//            extremes and refines them twice by linear least squares; halves are rounded up. This holds if all values
//            of the block are whole codes. Others are first rounded to 1/128 of a code, and fewer than one block in
//            1000 has a larger error than a plain fit of the rounded values: texels and endpoints in the middle
//            between two codes are not always rounded up. Three or more values that lie on a palette with spacings of
//            at least 4/3 codes, as those of blocks that were decoded earlier do, are encoded to the same values
//            within 1/10 of a code
//   fast     refines once and does not check the result. The root mean square error of a block may exceed that of the
//            palette between the extremes, before rounding, by the effect of rounding: half a code (of 255) in BC4
//            blocks, or one code if their range is smaller; 2.8 codes in dxt5nm's green (whose palette leaves 1/16 of
//            the range at both ends); and 1/400 of the range
enum class Effort { fast, normal, best };

inline constexpr Named<Effort> kEffortNames[] = {
    {Effort::fast, "fast", "for previews and iteration"},
    {Effort::normal, "normal", "close to the optimum"},
    {Effort::best, "best", "the least squared error"},
};

// The error that Effort::best minimises; the other efforts ignore it.
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

struct PackOptions {
    Encoding encoding = Encoding::dxt5nm;
    YAxis y_axis = YAxis::up;  // of the texture; down stores -y
    Effort effort = Effort::normal;
    Metric metric = Metric::component;
    bool y_known = true;  // whether the texture states y_axis; false if that is only an assumption about the source
};

// Packs every level of a chain.
//
// Quantisation is described at Encoding (format.h). Block encodings: each channel of a 4x4 block is fitted on its own
// (x in BC3's alpha or BC5's first block, y in the green of BC3's colour block or BC5's second block). If an extent is
// not a multiple of 4, texels outside repeat the last one and have no weight. In dxt5nm, R and B are 1 in both
// endpoints of every block, so that every decoder returns exactly 255. A flat block decodes to 127 or 128 in G and A
// under the rules of AMD, Intel and NVIDIA, within 0.23 degrees of (0, 0, 1).
//
// Preconditions (asserted): the chain has at least one level, each level has the extent of level_extent(), and
// components are finite.
// Errors: out_of_memory, cancelled.
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] Result<Texture> pack(const MipChain& chain, const PackOptions& options = {},
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
//
// BC4's layout is two endpoints of 8 bits, then 16 indices of 3 bits, texel 0 in the lowest bits, little-endian. BC3's
// colours are two of 5, 6 and 5 bits, red highest, then 16 indices of 2 bits (Direct3D 11.3 Functional Specification,
// 19.5). Bytes and errors are the same as those of pack().
//
// Preconditions (asserted): x and y have the same extent, at least 1x1; options.encoding is one of the three; pitch is
// at least 16 bytes for each block of a row; components are finite. Allocates no memory and starts no threads:
// different rows of blocks may be encoded at the same time.
void encode_blocks(PlaneView<const float> x, PlaneView<const float> y, const PackOptions& options, std::byte* blocks,
                   std::size_t pitch);

}  // namespace tex
#pragma GCC visibility pop
