// SPDX-License-Identifier: Apache-2.0
// horizon_sweep.h: the horizons of a field of heights in one direction, from row to row.
//
// A direction nearer to x than to y takes a field that is turned over its diagonal, with columns for rows: so each of
// its lines crosses every row. Line j is at column j + shift s in step s of the sweep, between two texels. Each texel
// takes the hull of the line that is nearest to its middle, and what is nearer than kNearRows from texels themselves.

#pragma once

#include <cstddef>

#include <tex/types.h>

#include "kernels/horizon.h"
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

// How a sweep goes.
struct SweepDirection {
    SkyDirection sky;
    double shift = 0.0;    // columns that a line moves from step to step, -1 to 1
    bool upwards = false;  // from the last row to the first: texels look for what is below them
    float bend = 0.0f;     // kernels/horizon.h
};

// One direction over all lines, a band at a time. Bands are independent of each other, and no texel is in two of them.
class HorizonSweep {
public:
    // The parameters must outlive this.
    HorizonSweep(const HorizonField& field, const SweepDirection& direction, SkySums& sums);

    [[nodiscard]] int bands() const { return bands_; }

    // Stacks for the hulls of a band, which any sweep over a field of this extent can use.
    class Stacks {
    public:
        explicit Stacks(Extent extent);

    private:
        friend class HorizonSweep;
        Plane<float> points_;  // most of it is never touched
        HullBand hulls_;
    };

    // Sums the light of the texels of a band.
    void sweep(int band, Stacks& stacks) const;

private:
    class Band;

    // The column of line 0 in a step, rounded.
    [[nodiscard]] int shift_at(int step) const { return shifts_[static_cast<std::size_t>(step + run_in_)]; }
    [[nodiscard]] int row_at(int step) const;

    const HorizonField& field_;
    const SweepDirection& direction_;
    SkySums& sums_;
    bool repeats_;
    int first_line_ = 0, lines_ = 0, bands_ = 0, run_in_ = 0;
    WorkingVector<int> shifts_;  // of all steps
};

}  // namespace tex::inline v1
