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
    HeightField field;               // with the bumpiness and the wraps of the options; its lowest height is 0
    float highest = 0.0f;            // its highest height: the range
    AngularError curl;               // what is left over: see below
    Plane<float> degrees;            // the angle of each texel; 0 if its normal is not finite
    std::int64_t unused_texels = 0;  // without a usable slope
    int steps = 1;                   // the number of times that the equation was solved
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
//     blind spots       A kernel does not see the frequencies at which its response is 0, and hardly sees those nearby.
//                       The result has none with a response below options.least_response, relative to that of the
//                       difference of neighbouring texels: of all fields with the same normals, it is the smoothest.
//                       `forward` sees every frequency. `central`, `scharr` and `prewitt` miss heights that alternate
//                       (+1 -1 +1 ...) along x, along y or along both, on axes that repeat and are even; `prewitt` also
//                       misses the period of three texels along both. `sobel`, `sobel5` and `gaussian` miss whatever
//                       alternates along one axis, and sobel5 and gaussian attenuate all fine detail: they give the
//                       heights of smooth surfaces back, not those of noise.
//     slopes of 1e15    bake() clamps them.
//
// Otherwise heights come back within 1e-4 of their range, for every kernel and wrap, up to extents of 16384 (within
// 5e-3 at 2^20, where the rounding of floats adds up); within 5e-4 for sobel5 on an axis that does not repeat, where
// it hardly sees how the heights end at the border. On other maps, the angle between the map and bake() of the
// result (`curl`, `degrees`) is what no height field can have. Rounding to 8 bits leaves a few tenths of a degree; more
// shows painting, blending, resizing, another kernel or damage.
//
// Texels with z below options.least_z have no usable slope, and neither have those with a component that is NaN or
// infinite. They count as unknown: the sum above is without them. The equation is then solved several times, up to
// options.most_steps, each time for what the slopes still lack. So it is with Wrap::clamp and the kernels that smooth.
//
// With Wrap::clamp, border texels weigh less than others: a quarter (central), or half (forward).
//
// Method: on an axis that repeats or is mirrored, the discrete Hartley or cosine transform turns derivatives into
// products; a clamped axis is reduced to a mirrored one. The time is that of the transforms, n log n, for every extent;
// extents with prime factors above 5 take four times as long along that axis. Memory: 8 bytes for each texel besides
// the map, 16 if several solutions are needed, and for each thread 128 bytes for each texel of the longer side (512 for
// prime factors above 5).
//
// Errors: bad_option  the map has no texels, or more than kMaxExtent in a direction; as validate(options)
//         bad_data  z is below 0 in more than one of sixteen texels, as in object space; no texel has a usable slope
//         out_of_memory, cancelled
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] Result<Integration> integrate(const NormalMap& map, const IntegrateOptions& options = {},
                                            const Execution& execution = {});

// Stretches heights in place: `low` becomes 0 and `high` becomes 1. If they are equal, every height becomes 0.
void stretch_heights(Plane<float>& heights, float low, float high, const Execution& execution = {});

}  // namespace tex
#pragma GCC visibility pop
