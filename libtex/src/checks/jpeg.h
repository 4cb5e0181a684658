// SPDX-License-Identifier: Apache-2.0
// jpeg.h: traces of JPEG quantisation in texels that were decoded from a JPEG.

#pragma once

#include "checks/stored.h"

namespace tex::inline v1 {

// A JPEG stores the cosine transform of 8x8 blocks of luma as multiples of a step for each coefficient. After decoding
// and rounding to 8 bits, coefficients still lie close to these multiples. (Fan, de Queiroz: Identification of Bitmap
// Compression History, 2003.)
struct JpegTrace {
    double strength = 0.0;  // 0 to 1: how closely; the median over the low coefficients. Below 0.3 without a JPEG
    double scale =
        0.0;  // of the steps, relative to the table of ITU-T T.81 annex K: 1 is quality 50 of libjpeg, 0.5 quality 75
    // The value to judge: a faint trace and a fine quantisation both reduce it.
    [[nodiscard]] double weight() const { return strength * scale; }
    // The quality as libjpeg numbers it, 1 to 100. Precondition: scale > 0.
    [[nodiscard]] double quality() const { return scale <= 1.0 ? 100.0 - 50.0 * scale : 50.0 / scale; }
};

// Examines blocks of 8x8 texels whose corners lie at multiples of 8, plus `offset` (0 to 7). A JPEG leaves its trace
// only at offset 0; a map of few distinct values has a similar trace at any offset. Finds no trace in maps that have
// fewer than three channels, have signed values, or are too small.
JpegTrace measure_jpeg(const Stored& stored, int offset = 0);

}  // namespace tex::inline v1
