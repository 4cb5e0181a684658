// SPDX-License-Identifier: Apache-2.0
// hemisphere.h: directions that fill a hemisphere evenly, each as often as its cosine says.
//
// The k-th of N directions comes from the k-th point (u, v) of Sobol's sequence in two dimensions, the first 2^m points
// of which have one in each rectangle of area 2^-m whose sides are powers of two. Each texel scrambles the digits of
// both numbers by a hash of its own (Owen's nested scrambling: Laine, Karras, Stratified Sampling for Stochastic
// Transparency, 2011; Burley, Practical Hash-based Owen Scrambling, JCGT 9 (4), 2020), so that neighbours do not repeat
// a pattern. Then the angle around the axis is 2 pi v and the sine of the angle from it sqrt(u), which makes the
// density cos / pi. All of it is integer arithmetic and + - * / sqrt, so the directions are the same on every machine.

#pragma once

#include <cstdint>
#include <vector>

#include "mesh/vector3.h"

namespace tex::inline v1 {

class Hemisphere {
public:
    explicit Hemisphere(int count);

    [[nodiscard]] int count() const { return static_cast<int>(points_.size()); }

    // What a texel scrambles its directions with. `place` is that of a sample in it.
    [[nodiscard]] static std::uint32_t seed_of(int i, int j, std::uint32_t place);

    // The directions about `axis`, which has unit length. Those that would lie below the plane with the normal `face`
    // are reflected by it. Each has unit length but for rounding. `directions` must have room for count() of them.
    void about(Vector3 axis, Vector3 face, std::uint32_t seed, Vector3* directions) const;

private:
    struct Point {
        std::uint32_t u, v;  // with the order of their bits reversed
    };
    // cos and sin of multiples of a turn / 256 and of a turn / 65536.
    struct Turn {
        double cos, sin;
    };
    std::vector<Point> points_;
    Turn coarse_[256], fine_[256];
};

}  // namespace tex::inline v1
