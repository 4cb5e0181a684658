// SPDX-License-Identifier: Apache-2.0
// lattice.h: slopes that lie on a lattice: the map was baked from heights of few grey levels.

#pragma once

#include "checks/stored.h"

namespace tex {

// Central differences of heights in steps of d are multiples of d/2: the histogram of slopes is a comb.
struct Lattice {
    double step = 0.0;      // of slopes, between its teeth
    double strength = 0.0;  // 0 (smooth) to 1 (every slope lies on a tooth)
    int teeth = 0;          // that hold at least 1 % of the slopes other than 0: few are a map's own flat faces
};

// Looks for teeth at distances from 0.0196, 2.5 codes of 8 bits (finer ones drown in the rounding of the codes), to
// 1/16.
Lattice measure_lattice(const Stored& stored);

}  // namespace tex
