// SPDX-License-Identifier: Apache-2.0
// curl.h: which way green points, told from the pixels.
//
// The slopes of a height field have no curl: dp/dy = dq/dx where y points up. In a map with y down dq/dx has the other
// sign, and in a map whose x and y are exchanged it is dp/dx and dq/dy that agree. (google/audit-normalmap, 2017, has
// the first idea.)

#pragma once

#include <vector>

#include "checks/stored.h"

namespace tex {

// Sums over texels, of which everything is a ratio.
struct CurlSums {
    double cross = 0.0;      // sum of dp/dy dq/dx, y up in the file's own sense
    double p_square = 0.0;   // sum of (dp/dy)^2
    double q_square = 0.0;   // sum of (dq/dx)^2
    double exchanged = 0.0;  // sum of dp/dx dq/dy
    double px_square = 0.0, qy_square = 0.0;

    void add(const CurlSums& other);
    // Correlations in [-1, 1]; 0 where nothing varies. +1: green is up, -1: green is down.
    [[nodiscard]] double correlation() const;
    [[nodiscard]] double exchanged_correlation() const;
};

inline constexpr int kCurlScales = 3;  // slopes as stored, halved, and halved again

// What one region of the map says.
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
    // 0.5 to 1: how likely the sign is right, each region being one witness whose weight is its evidence.
    double confidence = 0.5;
    double exchanged_confidence = 0.5;  // the same for the sign of exchanged
    double usable = 0.0;                // share of the sampled texels that hold a normal
};

Curl measure_curl(const Stored& stored);

}  // namespace tex
