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

// How hard the block encoders look for the smallest error (dxt5nm, bc5 and bc5_snorm; the others are exact). With
// normal and best no channel of a block has a greater squared error than a plain fit gives: endpoints at the extremes,
// twice refined by linear least squares, of values rounded to 1/128 of a code. Three or more values that lie on a
// palette with spacings of at least 4/3 codes, as those of blocks do that were decoded before, come out as they went
// in, to 1/10 of a code. With best no block could have a smaller error. fast does not check what it found: it refines
// once, and the root mean square error of a block may exceed that of the palette between the extremes, before these are
// rounded, by what rounding does: half a code (of 255) in BC4 blocks, one where their range is less, 2.8 in dxt5nm's
// green (where that palette leaves 1/16 of the range at both ends), and 1/400 of the range.
enum class Effort { fast, normal, best };

inline constexpr Named<Effort> kEffortNames[] = {
    {Effort::fast, "fast", "for previews and iteration"},
    {Effort::normal, "normal", "close to the optimum"},
    {Effort::best, "best", "the least squared error"},
};

// What Effort::best makes least; the others do not ask.
enum class Metric { component, angle };

// component: the squared error of each channel by itself; no block could have a smaller one. angle: the sum of the
// squared chords between the normals (2 - 2 cos of the angle, for small angles its square). It starts from the blocks
// that component gives, takes for each texel the best pair of values, and moves the endpoints while any step of up to 3
// codes of one endpoint, or of both of a channel, gains: no block has a greater sum than before, but that none could
// have a smaller one is not proved. On the 18 maps of encode_bench the mean angle falls by 4 %, the 99.9th percentile
// by 12 %, steep maps gain most; it does about a third of the texels a second that component does.
inline constexpr Named<Metric> kMetricNames[] = {
    {Metric::component, "component", "the squared error of each channel"},
    {Metric::angle, "angle", "the angle between normals, much slower"},
};

struct PackOptions {
    Encoding encoding = Encoding::dxt5nm;
    YAxis y_axis = YAxis::up;  // of the texture: down stores -y
    Effort effort = Effort::normal;
    Metric metric = Metric::component;
};

// Packs every level of a chain.
//
// Quantisation is described at Encoding (format.h). Block encodings: each channel of a 4x4 block is fitted by
// itself (x in BC3's alpha or BC5's first block, y in the green of BC3's colour block or BC5's second block).
// Where an extent is not a multiple of 4, texels outside repeat the last one and carry no weight. In
// dxt5nm R and B are 1 in both endpoints of every block, so that they decode to exactly 255 on every decoder, and
// a flat block decodes to 127 or 128 in G and A under the rules of AMD, Intel and NVIDIA, within 0.23 degrees of (0, 0,
// 1).
//
// Preconditions (asserted): the chain has at least one level and each level the extent of level_extent();
// components are finite.
// Errors: out_of_memory, cancelled.
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] Result<Texture> pack(const MipChain& chain, const PackOptions& options = {},
                                   const Execution& execution = {});

// The block encoders by themselves, for engines with memory and threads of their own: x and y of a level, or of whole
// rows of blocks of one, to blocks.
//
// Rows need no padding and may have any stride. Row r of blocks (texel rows 4 r to 4 r + 3) goes to blocks + r * pitch,
// its block b (texel columns 4 b to 4 b + 3) 16 b bytes on; there are (height + 3) / 4 rows of (width + 3) / 4 blocks.
// A block's 16 bytes are
//
//     dxt5nm            0 to 7: x, as BC3's alpha (BC4's layout); 8 to 15: y in the green of BC3's colours
//     bc5, bc5_snorm    0 to 7: x; 8 to 15: y; both in BC4's layout
//
// with BC4's layout: two endpoints of 8 bits, then 16 indices of 3 bits, texel 0 in the lowest bits, little-endian; and
// BC3's colours: two of 5, 6 and 5 bits, red highest, then 16 indices of 2 bits (Direct3D 11.3 Functional
// Specification, 19.5). The bytes are those of pack(), the errors too.
//
// Preconditions (asserted): x and y have one extent, of at least 1x1; options.encoding is one of the three; pitch is at
// least 16 bytes for each block of a row; components are finite. Takes no memory and starts no threads: different rows
// of blocks may be encoded at the same time.
void encode_blocks(PlaneView<const float> x, PlaneView<const float> y, const PackOptions& options, std::byte* blocks,
                   std::size_t pitch);

}  // namespace tex
#pragma GCC visibility pop
