// SPDX-License-Identifier: Apache-2.0
// levels.h: measures whether the smaller levels follow from the base level.

#pragma once

#include <tex/types.h>

#include "checks/background.h"
#include "checks/stored.h"

namespace tex::inline v1 {

// Texels `first` to `first + count - 1` of row j of a level as vectors, as stored or with z reconstructed. A texel
// without a usable normal is (0, 0, 0).
void vectors_of_row(const Stored& stored, int j, int first, int count, float* x, float* y, float* z);

// Averages of a level over the texels that each texel of the next level covers (for odd sizes weighted by the covered
// share), not normalised: of vectors, and of the base level as it is stored. Errors: cancelled, out_of_memory.
Result<NormalMap> averages_of(const NormalMap& larger, const Execution& execution);
Result<NormalMap> base_averages(const Stored& stored, const Execution& execution);

// The share of background in each texel of level 1, and the same of the next level.
Plane<float> background_share(const Background& background, Extent base);
Plane<float> background_share(const Plane<float>& larger);

// Compares a level with the averages of the base level over the same texels. r is the normalised average, a is the
// average before normalising, and s is the stored value. Only x and y of the three are compared, so that encodings with
// and without z are judged in the same way.
struct LevelMeasure {
    int level = 0;
    Extent extent;
    double signal = 0.0;            // root mean square of r about its mean: the detail to compare, in components
    double stored_signal = 0.0;     // the same for s: about 0 if a level faded to flat
    double correlation = 0.0;       // correlation of s with r, each about its mean
    double gain = 1.0;              // the g that minimises |s - g r|: below 1 if detail fades
    double shift_x = 0.0;           // how far s lies to the right of r, in texels of this level (Lucas, Kanade 1981)
    double shift_y = 0.0;           // and how far below
    double length = 1.0;            // mean length of the stored vectors; 1 if z is not stored
    double average_length = 1.0;    // mean length of a
    double error_normalised = 0.0;  // root mean square of s - r
    double error_average = 0.0;     // root mean square of s - a
};

// Compares level `level`. If `background` is given, texels that hold a share of it, and those beside them, are left
// out: programs filter it in different ways. If too few remain, the signal is 0. Errors: cancelled, out_of_memory.
Result<void> measure_level(const Stored& stored, const NormalMap& averages, int level, const Execution& execution,
                           LevelMeasure& measure, const Plane<float>* background = nullptr);

}  // namespace tex::inline v1
