// SPDX-License-Identifier: Apache-2.0
// horizon_sweep.h: the horizons of a field of heights in one direction, or in two that are opposite, from row to row.
//
// A direction nearer to x than to y takes a field that is turned over its diagonal, with columns for rows: so each of
// its lines crosses every row. Line j is at column j + slant r in row r, between two texels. Each texel takes the
// hull of the line that is nearest to its middle, and what is nearer than kNearRows from texels themselves.
//
// Opposite directions have the same lines. The horizons of the first one of a band are kept until those of the second
// are there, too, and both are added at once: slopes and sums lie far apart in memory.

#pragma once

#include <cstddef>

#include <tex/types.h>

#include "kernels/horizon.h"
#include "kernels/sky_light.h"
#include "memory/lent_memory.h"

namespace tex::inline v1 {

// Heights and slopes of a field in one of its two orientations.
struct HorizonField {
    Plane<float> heights;  // in the unit of distances; kHoleHeight is a hole
    Plane<float> p, q;     // slopes to the right and upwards, of the field that is not turned; empty: only sky view
    Wrap across = Wrap::repeat, down = Wrap::repeat;

    [[nodiscard]] Extent extent() const { return heights.extent(); }
};

// What is summed over directions, in the same orientation; planes that are not wanted are empty.
struct SkySums {
    Plane<float> occlusion, sky, x, y, z, horizon;

    [[nodiscard]] SkyRow at(int row, int column);
};

// One way of a sweep.
struct SweepDirection {
    SkyDirection sky;
    bool upwards = false;  // from the last row to the first: texels look for what is below them
};

// How sweeps go along the same lines.
struct SweepLines {
    SweepDirection directions[2];
    int count = 1;       // of the directions; the second one is opposite to the first
    double slant = 0.0;  // columns that a line moves from a row to the next, -1 to 1
    float bend = 0.0f;   // kernels/horizon.h
};

// One or two directions over all lines, a band at a time. Bands are independent of each other, and no texel is in two
// of them.
class HorizonSweep {
public:
    // The parameters must outlive this.
    HorizonSweep(const HorizonField& field, const SweepLines& lines, SkySums& sums);

    [[nodiscard]] int bands() const { return bands_; }

    // What a band needs, which any sweep over a field of this extent can use.
    class Stacks {
    public:
        explicit Stacks(Extent extent);

    private:
        friend class HorizonSweep;
        Plane<float> points_;  // most of it is never touched
        Plane<float> kept_;    // the horizons of the first of two directions, row by row
        HullBand hulls_;
    };

    // Sums the light of the texels of a band.
    void sweep(int band, Stacks& stacks) const;

private:
    class Band;

    // The column of line 0 in a row, rounded; also for rows of the run-in, which lie outside the field.
    [[nodiscard]] int shift_at(int row) const { return shifts_[static_cast<std::size_t>(row + run_in_)]; }

    const HorizonField& field_;
    const SweepLines& plan_;
    SkySums& sums_;
    bool repeats_;
    int first_line_ = 0, lines_ = 0, bands_ = 0, run_in_ = 0;
    WorkingVector<int> shifts_;  // of all rows
};

}  // namespace tex::inline v1
