// SPDX-License-Identifier: Apache-2.0
// surface.h: surfaces from normals, heights and curvature; what light does on the surface of heights.

#pragma once

#include <cstdint>
#include <vector>

#include <tex/bake.h>
#include <tex/height.h>
#include <tex/types.h>

namespace tex::inline v1 {

// -- integrate -----------------------------------------------------------------------------------------------------
//
// Normals to heights: the inverse of bake().

// The least response that lets the heights of a float map come back as integrate() promises. Kernels that smooth much
// attenuate many frequencies, and the rounding of floats in all of them adds up.
[[nodiscard]] constexpr float least_response_of(GradientKernel kernel) {
    return kernel == GradientKernel::sobel5 || kernel == GradientKernel::gaussian ? 3e-3f : 1e-3f;
}

struct IntegrateOptions {
    BakeOptions bake;  // how slopes were measured

    // What HeightField holds: the height of value 1.0 in texel widths; 1e-20 to 1e20 in magnitude.
    float bumpiness_x = 1.0f;
    float bumpiness_y = 1.0f;
    Wrap wrap_x = Wrap::repeat;
    Wrap wrap_y = Wrap::repeat;

    // Slopes of texels with a smaller z are unknown, as are those of normals that are not finite. 8 bits hold no
    // smaller z than 1/255 besides 0, and no slope above 127 to any use. Above 0, at most 1.
    float least_z = 1e-6f;
    // Frequencies at which the response of the kernel is below this fraction of a derivative's are left out: see
    // integrate(). Rounding to 8 bits is amplified up to its inverse: 0.1 keeps that out of sight. From 1e-6 to 1,
    // or 0: that of least_response_of() the kernel.
    float least_response = 0.0f;
    // The most solutions if one is not enough; they end before if heights change by less than 1e-5 of their range.
    int most_steps = 40;
};

// Whether every option is in its range. integrate() calls it first. Errors: bad_option, which names the option.
[[nodiscard]] TEX_API Result<void> validate(const IntegrateOptions& options);

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
// 5e-3 at 2^20, where the rounding of floats adds up). On axes that do not repeat, kernels that smooth hardly see how
// the heights end at the border: within 5e-4 for sobel5, and for gaussian within 2e-2 if sigma is above 1, within 7e-2
// if it is above 2. On other maps, the angle between the map and bake() of the result (`curl`, `degrees`) is what no
// height field can have. Rounding to 8 bits leaves a few tenths of a degree; more shows painting, blending, resizing,
// another kernel or damage.
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
//         bad_data    z is below 0 in more than one of sixteen texels, as in object space; no texel has a usable slope;
//                     slopes are so steep that heights do not fit floats
//         out_of_memory, cancelled
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] TEX_API Result<Integration> integrate(const NormalMap& map, const IntegrateOptions& options = {},
                                                    const Execution& execution = {});

// Stretches heights in place: `low` becomes 0 and `high` becomes 1. If they are equal, every height becomes 0.
TEX_API void stretch_heights(Plane<float>& heights, float low, float high, const Execution& execution = {});

// -- curvature -----------------------------------------------------------------------------------------------------
//
// How much the surface of a normal map bends.

// What is computed, in 1/texel: bumps (and edges) are positive, dents (and grooves) negative. With the slopes p = -x /
// z to the right and q = -y / z upwards:
//
//     mean         (dx/dx + dy/dy) / 2: half the divergence of the normals' x and y. This is the mean curvature of the
//                  surface, 1 / r on a sphere of r texels (do Carmo: Differential Geometry of Curves and Surfaces,
//                  1976)
//     divergence   -(dp/dx + dq/dy) / 2: half the negative Laplacian of the heights in texel widths. Equal to mean
//                  where the surface is flat, larger on slopes; linear in the heights
enum class CurvatureKind { mean, divergence };

inline constexpr Named<CurvatureKind> kCurvatureKindNames[] = {
    {CurvatureKind::mean, "mean", "the mean curvature of the surface"},
    {CurvatureKind::divergence, "divergence", "half the negative Laplacian of the heights"},
};

struct CurvatureOptions {
    CurvatureKind kind = CurvatureKind::mean;
    Wrap wrap_x = Wrap::repeat;
    Wrap wrap_y = Wrap::repeat;
};

struct Curvature {
    Plane<float> values;
    float least = 0.0f, greatest = 0.0f;
    double rms = 0.0;  // square root of the mean square
};

// Derivatives are central differences, (v[i + 1] - v[i - 1]) / 2, so the error falls with the square of the texel size.
// Beyond the border of an axis, components repeat (repeat), continue their slope (clamp: one-sided differences of first
// order), or are mirrored, with the component along the axis turned round (mirror). An axis of one texel does not bend.
//
// Texels with z below 1e-6 count as flat in `divergence`, which cannot have their slopes; so do, in both, texels with a
// component that is NaN or infinite.
//
// Errors: bad_option (the map has no texels, or more than kMaxExtent in a direction; an option has an unknown
// value), out_of_memory, cancelled.
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] TEX_API Result<Curvature> curvature(const NormalMap& map, const CurvatureOptions& options = {},
                                                  const Execution& execution = {});

// -- occlusion -----------------------------------------------------------------------------------------------------
//
// How much of the sky each texel of a height field sees: ambient occlusion, sky view, bent normals and horizons.

struct OcclusionOptions {
    // In how many directions the horizon is measured, from 4 to 1024: see occlusion() for the error.
    int directions = 32;
    // 0: everything counts, however far away. Above 0, in texels: the ground seems to bend down, so that what is
    // farther counts less, and what is at this distance only if it rises steeper than 45 degrees.
    float distance = 0.0f;
    bool occlusion = true, sky_view = false, bent = false;  // the maps that are made
    // In how many directions the horizons are made, too: from 4 to 64, or 0 for none.
    int horizons = 0;
};

// Whether every option is in its range. occlusion() calls it first. Errors: bad_option, which names the option.
[[nodiscard]] TEX_API Result<void> validate(const OcclusionOptions& options);

// The maps that the options ask for; the others are empty.
struct OcclusionMaps {
    Plane<float> occlusion;  // 0 to 1
    Plane<float> sky_view;   // 0 to 1
    NormalMap bent;
    // 0 to 1. In memory they lie one below the other: the rows of each follow those of the one before.
    std::vector<Plane<float>> horizons;
};

// What the surface of a height field hides from its texels. The surface is the one whose normals bake(field, bake)
// measures: heights times the bumpiness, in texel widths, interpolated bilinearly.
//
//     T_k         the horizon in the direction k of N, as a tangent: the greatest rise / distance of what lies there.
//                 h_k = atan(T_k) is its angle above the level, and at least 0 without a distance, as a wide ground
//                 is seen that far down alone.
//     occlusion   the part of the light of an even sky that reaches the texel, weighted by the cosine with its normal
//     n:
//                 (1 / pi) of the integral of max(0, n.w) over the directions w above the horizon. 1 is open, 0 is
//                 closed, as glTF and transfer() store it. Of a slope of a degrees above a wide plane, (1 + cos a) / 2.
//     sky_view    the part of the hemisphere about the vertical that is sky: the mean of 1 - sin(max(0, h_k)) (Zaksek,
//                 Ostir, Kokalj: Sky-View Factor as a Relief Visualization Technique, 2011). At the bottom of a
//                 hemispherical bowl 1 - sqrt(1/2), on a plane 1.
//     bent        the mean of the same directions as in occlusion, with the same weights, as a unit vector; n if no
//                 direction is open. This is what transfer() estimates by rays.
//     horizons    sin(max(0, h_k)) in the direction k / N of a turn, from x (to the right) towards y (upwards), for
//                 N = options.horizons, whatever options.directions is: light from a direction w of this azimuth
//                 reaches the texel if w.z is greater (Max: Horizon Mapping, 1988; Sloan, Cohen: Interactive Horizon
//                 Mapping, 2000). Between two directions a shader interpolates.
//
// With options.distance D, T_k is the greatest value of rise / distance - distance / D. Nothing ends abruptly, and
// nothing whose rise is below distance^2 / D counts.
//
// Beyond the border lies, with Wrap::repeat and Wrap::mirror, what these say; with Wrap::clamp the ground goes on as
// high as its border. As much of it counts as the map is long, and at least 256 texels. Heights that are NaN are holes:
// they hide nothing, and their texels become 1, 1, (0, 0, 1) and horizons of 0. On the ground (HeightField::ground),
// horizons have the strength of the middle row; normals have that of their own.
//
// Method: the horizons of all texels of a line in one pass, which keeps the upper convex hull of what lies behind
// (Timonen, Westerholm: Scalable Height Field Self-Shadowing, 2010; Barrett: Computing Skylight for 2D Height Fields by
// Finding 1D Height Field Horizons in Amortized Constant Time, 2011), on lines from row to row (from column to column
// in directions nearer to x) with heights interpolated between two texels. The three nearest rows are measured from the
// texel itself. The time is that of texels times directions, whatever the distance. The light between two directions
// is that of their horizons. Error of occlusion beside a reference of 512 directions and steps of a quarter texel, in
// the mean over rough maps (tests/bench/OCCLUSION.md): 0.0011 with 16 directions, 0.0007 with 32; of sky view twice
// that.
//
// Memory, besides the field and the maps: 16 bytes for each texel, 8 more if there are holes, and for each thread 2100
// bytes for each row or column of the longer side, of which it touches little.
//
// Errors: bad_option  the field has no texels, or more than kMaxExtent in a direction; bumpiness is not finite, or
//                     has another sign in one direction than in the other; as validate(options) and validate(bake)
//         bad_data    a height is infinite; all are NaN
//         out_of_memory, cancelled
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] TEX_API Result<OcclusionMaps> occlusion(const HeightField& field, const OcclusionOptions& options = {},
                                                      const BakeOptions& bake = {}, const Execution& execution = {});

}  // namespace tex::inline v1
