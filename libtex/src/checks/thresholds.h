// SPDX-License-Identifier: Apache-2.0
// thresholds.h: where the statistical rules draw the line between intact and damaged.
//
// The lines are drawn on half of the real maps that the tests know (tests/reference/real_maps.h: pictures sorted by the
// FNV-1a hash of their names, the first half) and reported on the other half, which had no say. A fitted line is the
// geometric mean, to two digits, of the largest value of an intact map of that half and the least of a damaged one, or
// the arithmetic mean where values have a sign or are shares. The unit test CheckThresholds does that again, fails
// where a number here is not what comes out, and prints both halves; CheckData and tests/bench/check_bench.cpp print
// what is detected and missed.

#pragma once

namespace tex::thresholds {

// -- fitted, with the two values they lie between -----------------------------------------------------------
inline constexpr double kJpegTrace = 0.61;        // JpegTrace::weight(): 0.47 (a JPEG of quality 75) and 0.80
inline constexpr double kLatticeStrength = 0.68;  // Lattice::strength: 0.63 and 0.72
inline constexpr double kSeamRatio = 1.8;         // Seam::worst(): 1.4 and 2.3
inline constexpr double kPaletteShare = 0.49;     // palette_share(): 0.000061 and 0.98
inline constexpr double kDarkCentre =
    0.063;  // Centre::distance() from where decoding as sRGB puts flat: 0.27 and 0.015
inline constexpr double kLightCentre = 0.048;  // the same for encoding: 0.23 and 0.010
inline constexpr double kLevelRelated = 0.44;  // LevelMeasure::correlation of a map's worst level: 0.83 and 0.06
inline constexpr double kLevelShift = 0.41;    // of its most shifted level, in texels: 0.23 and 0.71
inline constexpr double kLevelShort =
    0.01;  // mean length of its shortest level below the base level's: 0.0048 and 0.023

// -- set from the intact maps of that half alone -------------------------------------------------------------
// A second chance for what changed after its JPEG, where the trace is gone and some maps show no steps: a tenth above
// the largest, 1.5.
inline constexpr double kJpegRatio = 1.7;  // grid_ratio(8)

}  // namespace tex::thresholds
