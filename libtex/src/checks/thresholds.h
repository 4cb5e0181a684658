// SPDX-License-Identifier: Apache-2.0
// thresholds.h: the thresholds with which the statistical rules separate intact maps from damaged ones.
//
// The thresholds are fitted to half of the real maps that the tests know (tests/reference/real_maps.h: pictures sorted
// by the FNV-1a hash of their names, the first half). Results are reported for the other half, which did not influence
// them. A fitted threshold is the geometric mean, to two digits, of the largest value of an intact map of that half and
// the least value of a damaged one. If values have a sign or are shares, it is the arithmetic mean. The unit test
// CheckThresholds repeats this, fails if a number here differs from the result, and prints both halves. CheckData and
// tests/bench/check_bench.cpp print what is detected and missed.

#pragma once

namespace tex::inline v1::thresholds {

// -- fitted, with the two values they lie between -----------------------------------------------------------
inline constexpr double kJpegTrace = 0.61;        // JpegTrace::weight(): 0.47 (a JPEG of quality 75) and 0.80
inline constexpr double kLatticeStrength = 0.68;  // Lattice::strength: 0.63 and 0.72
inline constexpr double kSeamRatio = 1.8;         // Seam::worst(): 1.4 and 2.3
inline constexpr double kPaletteShare = 0.49;     // palette_share(): 0.000061 and 0.98
inline constexpr double kDarkCentre =
    0.063;  // Centre::distance() from the value of a flat map after decoding as sRGB: 0.27 and 0.015
inline constexpr double kLightCentre = 0.048;  // the same for encoding: 0.23 and 0.010
inline constexpr double kLevelRelated = 0.44;  // LevelMeasure::correlation of a map's worst level: 0.83 and 0.06
inline constexpr double kLevelShift = 0.41;    // of its most shifted level, in texels: 0.23 and 0.71
inline constexpr double kLevelShort =
    0.01;  // how far the mean length of its shortest level is below that of the base level: 0.0048 and 0.023

// -- set from the intact maps of that half alone -------------------------------------------------------------
// A second test, for maps that changed after their JPEG: the trace is gone, and some maps show no steps. A tenth above
// the largest value, 1.5.
inline constexpr double kJpegRatio = 1.7;  // grid_ratio(8)

// -- of turned pictures and of slopes without a surface ---------------------------------------------------------------
// TurnSums::strength(). Pictures turned by 30 degrees have 0.65 to 1.00; intact maps whose angle is above 10 degrees at
// most 0.57.
inline constexpr double kTurnStrength = 0.6;
// TurnSums::angle() of axes that strong, in degrees. Intact maps have at most 2, and after BC1 or JPEG of quality 50 at
// most 6; JPEGs of faint bumps reach 13. Turns of 30 and 50 degrees measure 23 to 57.
inline constexpr double kTurnAngle = 15.0;
// Noise has a share of curl of 0.49 to 0.50 and a correlation of 0.00 to 0.01 at all scales. Of the intact maps, those
// baked on meshes are closest: a share of 0.32 with a correlation of 0.11 (FlightHelmet), 0.37 with 0.21 (MaterialX).
inline constexpr double kNoiseCurl = 0.43;
inline constexpr double kNoiseCorrelation = 0.05;

// -- of pictures that are no normal maps: kind.h ----------------------------------------------------------------------
// Set on the half of the files of ../shared/data/wild4 whose names have an even first byte of their SHA-256, and of
// these colour pictures made darker, lighter, brown, beige, violet and grey. The nature of the two gives wide margins.
// Share of vectors of about unit length. Normal maps have 0.84 and more, after JPEG and BC1, too. Colour pictures have
// up to 0.57; those of one light colour have up to 1, and centre elsewhere.
inline constexpr double kUnitShare = 0.75;
// The share after a damage was undone. Rounding came in between: 0.63 and more.
inline constexpr double kRestoredShare = 0.6;
inline constexpr double kRestoredSurely = 0.9;  // colour pictures that centre then: at most 0.46
// Medians of x and y, or of the two components that are not near 1. Leaning maps: up to 0.29.
inline constexpr double kCentred = 0.35;
inline constexpr double kLostCentred = 0.1;      // of y alone: roughness between occlusion and metalness of 1 has 0.15
inline constexpr double kRestoredCentre = 0.15;  // sRGB, read the other way: at most 0.03
inline constexpr double kUprightMedian = 0.6;    // of z then
// Correlation of x and y. Colours are bright or dark in all channels: 0.8 to 1 in most. Normal maps whose vectors do
// not follow each other: at most 0.48.
inline constexpr double kColorRelated = 0.8;
inline constexpr double kRestoredRelated = 0.6;
inline constexpr double kNoiseOnly = 0.03;  // standard deviation of x and y below which a correlation means nothing
// Correlation of z with sqrt(1 - x^2 - y^2), if that varies by kZImplied or more. Light colours have -0.7 to -1.
inline constexpr double kZFollows = 0.5;
inline constexpr double kZImplied = 0.012;
inline constexpr double kAllDirections = 0.3;  // variances of x, y and z together: maps in object space have 0.9
inline constexpr double kGreyTexels = 0.9;     // share of texels whose R, G and B are alike
// Two components beside other data in blue, as in LabPBR: x and y centre, do not follow each other, stay inside of the
// unit circle. The maps have medians up to 0.17, correlations up to 0.42, none outside, and up to 0.4 grey.
inline constexpr double kMostGrey = 0.5;
inline constexpr double kMostOutside = 0.02;
inline constexpr double kTwoCentred = 0.3;
inline constexpr double kTwoRelated = 0.5;
inline constexpr double kLevelShare = 0.25;     // of texels with x and y near 0: few others may follow each other more
inline constexpr double kLeastLevel = 0.01;     // least such share, unless curl shows a surface; maps: 0.045 and more
inline constexpr double kBevelsCentred = 0.1;   // slopes to all sides without a level texel between; two hues: 0.18
inline constexpr double kTwoVariance = 0.3;     // of x and y, unless curl shows a surface; noise over all codes: 0.67
inline constexpr double kFewBehind = 0.0005;    // share of vectors with z below -0.1
inline constexpr double kFewNull = 0.0001;      // of vectors without length, if alpha holds heights
inline constexpr double kOtherUnit = 0.5;       // of vectors of unit length: grey around charts leaves more of them
inline constexpr double kSurfaceCentred = 0.6;  // if curl shows that the slopes are those of a surface

// -- of meshes, set on Suzanne (Blender) and the materials of FlightHelmet (Babylon's exporter) ----------------------
inline constexpr double kTangentLength = 0.01;  // from 1: at most 0.0000002 there; 8-bit snorm: 0.007
inline constexpr double kTangentSign = 0.01;    // of |w| from 1: 0 there, and in 8-bit snorm
inline constexpr double kOppositeSigns = 0.05;  // share of triangles: at most 0.0001; 1 if all are flipped
// p99 in degrees. Suzanne: 3.6, perhaps because Blender's MikkTSpace runs on quads. FlightHelmet, which is known not to
// be exact: 4.6 to 15.
inline constexpr double kTangentAngle = 5.0;
// Median in degrees. Engines light a bump as if the light had been turned by that angle (tests/engines/RESULTS.md): at
// 60 degrees, half of the difference between its two sides is left; at 90, none; above, bumps are dents.
inline constexpr double kTangentsAside = 60.0;
// Slopes of compare_gaps() (mesh_seams.h), for maps made from a field on the real meshes, at 1024 and 2048 texels, 8
// bits. Green flipped: at least 0.998; green right: at most 0.002. The maps that came with the models: 0.24 to 0.69, so
// that nothing is said about them. Perhaps their bevels are too narrow for their texels.
inline constexpr double kSeamSlope = 0.1;  // from 0 or 1
// The right decoder of made maps: at least 0.90. The others: at most 0.44.
inline constexpr double kSeamFit = 0.65;
// In degrees: an estimate of what rounding to 8 bits adds to a gap (root mean square), 0.2 for each side.
inline constexpr double kSeamGap = 0.27;
// Mean angle from the normals of the mesh, divided by that from z. The maps of the models: at least 9.7. One in object
// space: 0.23.
inline constexpr double kObjectSpace = 0.5;

// In degrees, between the normals at the centre of a quad. Flat and evenly bent quads have 0.
inline constexpr double kQuadAngle = 5.0;

// -- of padding, from custom: 16 texels at 2048, 8 at 1024, which keep the levels down to a side of 128 clean --------
inline constexpr int kPaddedSide = 128;
inline constexpr double kBackground = 0.1;  // share of one value among the texels outside of charts
inline constexpr double kBleed = 0.17;      // the least difference in x and y that harms: about 10 degrees
inline constexpr double kBleedShare = 0.1;  // of the texels on borders

}  // namespace tex::inline v1::thresholds
