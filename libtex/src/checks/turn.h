// SPDX-License-Identifier: Apache-2.0
// turn.h: compares the curl of the slopes with their divergence: finds pictures that were turned without their vectors,
// and slopes that are those of no surface.
//
// The slopes p and q of a height field have no curl, only divergence. If its picture is turned by an angle and its
// vectors are not, the same texels have
//
//     curl = sin(angle) L,    divergence = cos(angle) L,    L = the Laplacian of the heights
//
// so the angle is that of the long axis of all pairs (divergence, curl). Noise has as much curl as divergence, and no
// axis.
//
// The share of curl alone says little. It is 0 for the bake of a height field, but 0.15 to 0.40 for intact maps that
// were baked from a high-poly model: they also make up for the normals of the low-poly mesh, which no height field has.
// Painting over a map and blending it wrongly lead to the same shares. The axis of such maps stays within 6 degrees.
// (Nothing is gained by integrating the whole map, which takes ten times as long: its residual is this curl.)

#pragma once

#include <tex/types.h>

#include "checks/stored.h"

namespace tex::inline v1 {

// Sums over texels, with y as the file has it.
struct TurnSums {
    double curl = 0.0, divergence = 0.0, product = 0.0;  // squares, and curl times divergence

    void add(const TurnSums& other);
    [[nodiscard]] double share() const;     // of curl in both squares; 0.5 for noise
    [[nodiscard]] double angle() const;     // of the axis, in degrees, -90 to 90; counterclockwise
    [[nodiscard]] double strength() const;  // of the axis: 0 if there is none, 1 if all pairs lie on it
};

// What one scale of the slopes shows.
struct TurnScale {
    TurnSums up, down;  // if y points up and down
    double weight = 0.0;
    double p_square = 0.0, q_square = 0.0, p_q = 0.0;  // of their changes along both axes

    void add(const TurnScale& other);
    // The direction of y in which the axis is clearest, and that in which the curl is least.
    [[nodiscard]] const TurnSums& clearest() const;
    [[nodiscard]] double curl_share() const;
    // Root mean square of the change of a slope over two texels, that along x and that along y together.
    [[nodiscard]] double rms() const;
    // How much the changes of p are those of q, from 0 to 1. At 1 all slopes have one direction: brushed metal, or
    // noise that R and G share because a JPEG stores their mean. Both have an axis without having been turned.
    [[nodiscard]] double shared() const;
};

struct Turn {
    static constexpr int kScales = 3;  // slopes as stored, halved once, and halved twice
    TurnScale scale[kScales];
};

// Measures the texels of sample_windows(). Errors: cancelled, out_of_memory.
Result<Turn> measure_turn(const Stored& stored, const Execution& execution);

}  // namespace tex::inline v1
