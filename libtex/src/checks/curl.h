// SPDX-License-Identifier: Apache-2.0
// curl.h: finds the direction of green from the texels.
//
// The slopes of a height field have no curl: dp/dy = dq/dx if y points up. In a map with y down, dq/dx has the other
// sign. In a map whose x and y are exchanged, dp/dx and dq/dy agree instead. (The first idea comes from
// google/audit-normalmap, 2017.)

#pragma once

#include <functional>
#include <vector>

#include <tex/types.h>

#include "checks/stored.h"

namespace tex::inline v1 {

inline constexpr float kSlopeJump = 0.5f;         // a change of slope over two texels that counts as a jump
inline constexpr double kLeastCorrelation = 0.2;  // smaller ones prove nothing
inline constexpr double kLeastConfidence = 0.99;
inline constexpr double kLeastUsable = 0.5;  // the share of texels that must hold a normal to prove anything

// The least energy of changes across (of p upwards, of q to the right), relative to those along. Lines, bevels and
// waves along the axes have none; rounding and block codecs then make up to 0.0083, and it has a sign, because they
// round z or x and y together. Maps of structures along the axes that show their direction have 0.036 and more.
inline constexpr double kLeastAcross = 0.017;

// When x and y count as exchanged (N308), or as in the other order (channel_order.h).
inline constexpr double kExchangedLead = 0.1;  // of one correlation before the other
inline constexpr double kExchangedLeast = 0.2;
inline constexpr double kExchangedConfidence = 0.99;
inline constexpr double kMostDiagonal = 0.65;  // of diagonal_share(): real maps have at most 0.48, ropes 0.80 and more
inline constexpr double kExchangedEnergy = 0.25;  // of products of two energies: the change across is half that along

// Sums over texels. All results are ratios of these sums.
struct CurlSums {
    double cross = 0.0;      // sum of dp/dy dq/dx, with y up as the file defines up
    double p_square = 0.0;   // sum of (dp/dy)^2
    double q_square = 0.0;   // sum of (dq/dx)^2
    double exchanged = 0.0;  // sum of dp/dx dq/dy
    double px_square = 0.0, qy_square = 0.0;

    void add(const CurlSums& other);
    // Whether the slopes change across enough for correlation().
    [[nodiscard]] bool changes_across() const;
    // Correlations in [-1, 1]; 0 if nothing varies, or if changes_across() is false. +1: green is up, -1: it is down.
    [[nodiscard]] double correlation() const;
    [[nodiscard]] double exchanged_correlation() const;
};

inline constexpr int kCurlScales = 3;  // slopes as stored, halved once, and halved twice

// What one region of the map shows.
struct CurlRegion {
    Rect rect;  // in texels of the map
    CurlSums scale[kCurlScales];
};

struct Curl {
    std::vector<CurlRegion> regions;
    CurlSums scale[kCurlScales];

    // The scale at which the evidence is strongest, and the correlations there.
    int best_scale = 0;
    double correlation = 0.0;
    double exchanged = 0.0;
    // How likely the sign is right, from 0.5 to 1. Each region is one witness, weighted by its evidence.
    double confidence = 0.5;
    double exchanged_confidence = 0.5;  // the same for the sign of `exchanged`
    double usable = 0.0;                // share of the sampled texels that hold a normal
};

Curl measure_curl(const Stored& stored);

// Measures on several threads. Reports no progress. Errors: out_of_memory.
Result<Curl> measure_curl(const Stored& stored, const Execution& execution);

// Measures parts of a map of this extent; `slopes` returns the slopes of a part, once for each.
Curl measure_curl(Extent extent, const std::vector<Rect>& windows, const std::function<Slopes(std::size_t)>& slopes);

// How diagonal the structures are, at a quarter of the resolution, from 0 (without a preferred direction, or along the
// axes) to 1 (lines at 45 degrees, of either direction). Where they are diagonal, x and y have no curl either way:
// exchanging them mirrors the structure onto itself.
double diagonal_share(const Stored& stored);
double diagonal_share(const std::vector<Slopes>& parts);

}  // namespace tex::inline v1
