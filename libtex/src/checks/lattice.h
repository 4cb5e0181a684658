// SPDX-License-Identifier: Apache-2.0
// lattice.h: finds slopes that lie on a lattice, because the map was baked from heights of few grey levels.

#pragma once

#include "checks/stored.h"

namespace tex::inline v1 {

// Central differences of heights in steps of d are multiples of d/2, so the histogram of slopes is a comb.
struct Lattice {
    double step = 0.0;      // distance between teeth, in units of slope
    double strength = 0.0;  // 0 (smooth) to 1 (every slope lies on a tooth)
    // The share of sloping texels between whose neighbours the slope changes unevenly, by half a step or more. Steps of
    // heights do this everywhere; the smooth curves of yarns and rivets, whose slopes grow by one step a texel, do not.
    double uneven = 0.0;
    int teeth = 0;  // with at least 1 % of the slopes other than 0: few are a map's own flat faces
};

// Looks for teeth at distances from 0.0196, which is 2.5 codes of 8 bits (finer ones are lost in the rounding of the
// codes), to 1/16.
Lattice measure_lattice(const Stored& stored);

}  // namespace tex::inline v1
