// SPDX-License-Identifier: Apache-2.0
// chroma.h: colours that were stored at half the resolution of luma, as by JPEG, lossy WebP and video (4:2:0, 4:2:2).

#pragma once

#include "checks/background.h"
#include "checks/stored.h"

namespace tex::inline v1 {

// How much Y and Cr of JFIF (ITU-T T.871) differ within squares of 2x2 texels, in codes of 8 bits, rms. R and G, which
// hold x and y, have opposite signs in Cr.
struct ChromaDetail {
    double luma = 0.0, chroma = 0.0;                    // between left and right, and between top and bottom
    double luma_diagonal = 0.0, chroma_diagonal = 0.0;  // between both diagonals: filters that enlarge leave none of it
    double share = 0.0;                                 // of squares, that have such detail in luma
    // In normal maps, Cr has 0.7 to 1.2 of the detail of Y. Whether it is gone, and Y has enough to tell: in flat maps,
    // rounding is all that there is.
    [[nodiscard]] bool is_halved() const;
    // What Cr has lost, if it had as much as luma has.
    [[nodiscard]] double lost() const;
};

// Looks at the squares of 16 windows of 128x128 texels in which no texel is background, which may be null, or a colour
// that is no vector: the border of a chart has luma alone. Zero unless x, y and z are stored, unsigned.
ChromaDetail measure_chroma(const Stored& stored, const Background* background);

// The picture at a quarter of its size, which chroma at half resolution fills: the means of 4x4 texels.
Image quarter_of(const Stored& stored);

}  // namespace tex::inline v1
