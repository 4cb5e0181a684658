// SPDX-License-Identifier: Apache-2.0
// pack_options.h: how textures are encoded: see pack.h.

#pragma once

#include <tex/format.h>
#include <tex/names.h>
#include <tex/normal_map.h>

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
enum class Effort { fast, normal, best };

inline constexpr Named<Effort> kEffortNames[] = {
    {Effort::fast, "fast", "for previews and iteration"},
    {Effort::normal, "normal", "close to the optimum"},
    {Effort::best, "best", "the least squared error"},
};

// The error that Effort::best minimises; the other efforts and EAC ignore it: component.
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

}  // namespace tex
#pragma GCC visibility pop
