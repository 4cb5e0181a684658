// SPDX-License-Identifier: Apache-2.0
// deband.h: smooth heights from rounded ones.

#pragma once

#include <tex/deband_options.h>
#include <tex/execution.h>
#include <tex/height_field.h>
#include <tex/result.h>

#pragma GCC visibility push(default)
namespace tex {

// Replaces heights that were rounded to steps (those of 8 bits, for example) by smooth ones that round to the same
// steps. Slopes are then no longer those of terraces. HeightOptions::deband does it while a picture is read.
//
// The steps. Heights lie on steps if all are c + k step for integers k, within 0.6 / 65535 or a quarter of a millionth
// of the largest magnitude, whichever is larger (but at most a tenth of a step). The step is found from the heights
// alone, so that 8 bits are recognised in a file of 16 bits, padded or stretched. There are at most 4096 steps from the
// lowest height to the highest; a step is at most 1/32, or the heights span at least 32 of them. Other heights stay as
// they are: those of 16 bits, floats, and those that a colour space, luma or a blur made uneven.
//
// The heights. With heights in steps, k is the input, h the result and L the difference of the four neighbours' mean
// from a texel, times 4 (the Laplacian):
//
//     the least sum of (L h)^2 + w (h - k)^2,    k - 0.499 <= h <= k + 0.499
//
// that is, the field of least bending energy that rounds to the input, with a pull w >= 0 to the input. No height
// leaves the range from 0 to 1 where the input ends at 0 or at 1. Where the ground is smooth, w is 0. Where it is
// rough, rounding acts as white noise of variance 1/12, and the best estimate is that of a Wiener filter: w is 12 times
// the variance of L h (Wiener 1949). It is estimated as the local mean of (L k)^2, less 20/12 for the noise; the
// means of 2x2 texels must confirm it, with 4 times their energy less 0.6, and an energy of at least 1, so that the
// beat of a steady slope with the steps is not mistaken for roughness. Where w > 300, heights stay at their codes: the
// pull would move them by about 1 / sqrt(12 w), a sixtieth of a step, and the plateaus between cliffs stay flat.
//
// Method: from coarse grids to fine ones; on each, a fixed number of projected gradient steps with momentum (Beck,
// Teboulle 2009): more on coarse grids, where they are cheap and reach far. A coarse grid has every other texel of the
// finer one, with its bounds, and a pull where the ground is rough at that scale. Cubic interpolation takes
// its heights to the finer one (Dubuc 1986). The bending energy is near its least, not at it; the bounds hold exactly.
//
// Texels that are NaN have no bounds and stay NaN; the field bends through them. Wraps are those of the field; with
// Wrap::clamp, slopes continue. Every height depends on all others. Memory: 9 bytes for each texel besides the field.
//
// Errors: bad_option (the field has no texels, or more than kMaxExtent in a direction); out_of_memory, cancelled: the
//         heights are then lost
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] Result<DebandReport> deband(HeightField& field, Deband when = Deband::on,
                                          const Execution& execution = {});

}  // namespace tex
#pragma GCC visibility pop
