// SPDX-License-Identifier: Apache-2.0
// integrate.h: normals to heights: the inverse of bake().

#pragma once

#include <cstdint>

#include <tex/angular_error.h>
#include <tex/execution.h>
#include <tex/height_field.h>
#include <tex/image.h>
#include <tex/integrate_options.h>
#include <tex/normal_map.h>
#include <tex/result.h>

#pragma GCC visibility push(default)
namespace tex {

struct Integration {
    HeightField field;          // with the bumpiness and the wraps of the options; its lowest height is 0
    float highest = 0.0f;       // its highest height: the range
    AngularError curl;          // what is left over: see below
    Plane<float> degrees;       // the angle of each texel
    std::int64_t unused_texels = 0;  // whose z is below IntegrateOptions::least_z
    int steps = 1;              // the number of times that the equation was solved
};

// The heights h whose slopes are nearest to those of the map in the mean square (Frankot, Chellappa: A Method for
// Enforcing Integrability in Shape from Shading Algorithms, 1988):
//
//     the least sum of (p - bumpiness_x du)^2 + (q - bumpiness_y dv)^2,    p = -x / z,  q = -y / z
//
// where du and dv are the slopes that bake() measures with the same kernel and wraps, to the right and upwards in
// heights per texel. Integrating what bake() made gives its heights back, apart from what no normal shows:
//
//     the constant      The lowest height becomes 0.
//     blind spots       A kernel does not see the frequencies at which its response is 0. The result has none of them,
//                       which makes it the smoothest and smallest of all fields with the same normals. `forward` sees
//                       every frequency. `central` and `scharr` miss alternating heights (+1 -1 +1 ...) along x, along
//                       y and along both, if the axes repeat and their extent is even. `prewitt` misses these and the
//                       period of three texels along both axes. `sobel` and `sobel5` miss everything that alternates
//                       along an axis that repeats and is even. `gaussian` with a sigma above 1.3 misses fine detail,
//                       as what it attenuates by more than 10000 counts as unseen.
//     slopes of 1e15    bake() clamps them.
//
// On the maps of a height field rounding is all that is left: heights are within 1e-4 of their range in every wrap. On
// other maps, the angle between the map and bake() of the result (`curl`, `degrees`) measures what no height field can
// have: the rounding of 8 bits leaves 0.1 to 0.3 degrees; more shows painting, blending, resizing or damage.
//
// Texels with z below options.least_z have no usable slope. They count as unknown: the sum above is without them. That
// takes several solutions, each of which starts from the slopes of the last one in these texels, as does Wrap::clamp
// with kernels that are not differences of two texels (forward, central): up to options.most_steps.
//
// With Wrap::clamp, border texels weigh less than others: a quarter (central), or half (forward).
//
// Method: on an axis that repeats or is mirrored, the discrete Hartley or cosine transform turns derivatives into
// products; a clamped axis is reduced to a mirrored one. The time is that of the transforms, n log n, for every extent;
// extents with prime factors above 5 take four times as long along that axis. Memory: 8 bytes for each texel besides
// the map, 16 if several solutions are needed, and for each thread 128 bytes for each texel of the longer side (512 for
// prime factors above 5).
//
// Preconditions (asserted): the map is not empty, of at most kMaxExtent; its components are finite; bumpiness is finite
// and not 0, with the larger one at most 1e6 times the smaller one; gaussian_sigma in range; 0 < least_z <= 1.
// Errors: bad_data  z is below 0 in more than one of sixteen texels, as in object space; no z is at least least_z
//         out_of_memory, cancelled
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] Result<Integration> integrate(const NormalMap& map, const IntegrateOptions& options = {},
                                            const Execution& execution = {});

// Stretches heights in place: `low` becomes 0 and `high` becomes 1. If they are equal, every height becomes 0.
void stretch_heights(Plane<float>& heights, float low, float high, const Execution& execution = {});

}  // namespace tex
#pragma GCC visibility pop
