// SPDX-License-Identifier: Apache-2.0
// pack_options.h: how textures are encoded: see pack.h.

#pragma once

#include <tex/format.h>
#include <tex/names.h>
#include <tex/normal_map.h>
#include <tex/result.h>

#pragma GCC visibility push(default)
namespace tex {

// How hard the block encoders search for the smallest error (dxt5nm, bc5, bc5_snorm, eac_rg11 and eac_rg11_snorm; the
// others are exact).
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
enum class Effort { fast, normal, best };

inline constexpr Named<Effort> kEffortNames[] = {
    {Effort::fast, "fast", "for previews and iteration"},
    {Effort::normal, "normal", "close to the optimum"},
    {Effort::best, "best", "the least squared error"},
};

// The error that Effort::best minimises; the other efforts, EAC and ASTC ignore it: component.
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
// block by one that copies the indices, and perhaps the endpoints, of blocks shortly before it. It takes the block with
// the least D + lambda R (Sullivan and Wiegand, 1998): D is the sum of the angles of its texels, R its estimated size
// as matches and literals of a Lempel-Ziv coder.
//
// It applies to dxt5nm, bc5, bc5_snorm, eac_rg11 and eac_rg11_snorm; the other encodings ignore it. A level is divided
// into bands of whole rows of blocks, from the top: as many rows as a power of two needs to give a band of the base
// level at least 16384 blocks, and as many in the smaller levels. Bands do not depend on each other. Memory therefore
// holds a few of them, and the bytes are the same for every number of threads. Each band has its own lambda, the
// greatest one found that keeps the promise.
//
// The promise concerns the angles between the normals of the source and those of the blocks, as compare() measures
// them: on both sides, z = sqrt(1 - x^2 - y^2), or 0 where x^2 + y^2 is above 1, and then the vector is made unit.
//
//   mean     the mean angle of every band, and so of every level, exceeds that of the same encoding without
//            optimisation by at most so many degrees
//   max      no texel's angle exceeds both `max` degrees and its own angle without optimisation; if `max` is 0, it is
//            kRdoMaxOfMean times the mean angle that the band may have, so that smooth maps stay smooth
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
    double most_growth = 0.0;  // the greatest growth of a band's mean angle: at most RdoOptions::mean
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
[[nodiscard]] Result<void> validate(const PackOptions& options);

}  // namespace tex
#pragma GCC visibility pop
