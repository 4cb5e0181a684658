// SPDX-License-Identifier: Apache-2.0
// mip.h: mip chains of normal maps, renormalised.

#pragma once

#include <optional>

#include <tex/execution.h>
#include <tex/height_field.h>
#include <tex/mip_chain.h>
#include <tex/names.h>
#include <tex/result.h>

#pragma GCC visibility push(default)
namespace tex {

// The filter between a level and the next. x is the distance from the centre of the smaller level's texel, in texels of
// the smaller level; weights are normalised to sum 1 for each texel.
//
//   box            1 for |x| <= 1/2; each texel is weighted by its covered part, so that odd sizes give exact
//                  averages (Guthe, Heckbert: Non-Power-of-Two Mipmapping, NVIDIA 2005)
//   triangle       1 - |x|, |x| < 1
//   kaiser         sinc(x) times a Kaiser window of radius 3, alpha 4 (as NVIDIA's Texture Tools)
//   mitchell       B = C = 1/3, radius 2 (Mitchell, Netravali 1988)
//   catmull-rom    B = 0, C = 1/2, radius 2
//   lanczos3       sinc(x) sinc(x / 3), radius 3
//
// All but box are sampled at the centres of the larger level's texels.
enum class MipFilter { box, triangle, kaiser, mitchell, catmull_rom, lanczos3 };

inline constexpr Named<MipFilter> kMipFilterNames[] = {
    {MipFilter::box, "box", "exact average of the texels covered"},
    {MipFilter::triangle, "triangle", "softer"},
    {MipFilter::kaiser, "kaiser", "sharper, radius 3"},
    {MipFilter::mitchell, "mitchell", "Mitchell-Netravali, radius 2"},
    {MipFilter::catmull_rom, "catmull-rom", "sharper, radius 2"},
    {MipFilter::lanczos3, "lanczos3", "sharpest, radius 3"},
};

// What is averaged.
enum class MipDomain {
    vector,  // the vectors x, y, z
    slope,   // the slopes x/z and y/z (z at least 1/256): exact for height fields, as heights average
};

inline constexpr Named<MipDomain> kMipDomainNames[] = {
    {MipDomain::vector, "vector", "average the vectors"},
    {MipDomain::slope, "slope", "average the slopes: exact for height fields"},
};

// Fading out (Unity's "Fadeout Mip Maps"): level k moves to flat, (0, 0, 1), by t = clamp((k - first) / (last - first),
// 0, 1). Level `last` and all smaller levels are flat. Precondition: 0 <= first < last.
struct Fade {
    int first = 1;
    int last = 3;
};

struct MipOptions {
    int levels = 0;  // number of levels, counting the base level; 0, or more than there can be, is a complete chain
    MipFilter filter = MipFilter::box;
    MipDomain domain = MipDomain::vector;
    std::optional<Fade> fade;
    Wrap wrap_x = Wrap::repeat;  // clamp repeats the border texel, mirror does not flip vectors
    Wrap wrap_y = Wrap::repeat;
};

// Builds the chain. Each level is filtered from the previous level before that one is normalised, so that a level is
// the true average of the base level. The stored vector is
//
//     normalize(lerp(normalize(average), (0, 0, 1), t))
//
// A z below 0 (from filters with negative lobes) becomes 0 first, and a vector shorter than 1e-6 becomes (0, 0, 1). The
// base level is stored as given: t is 0 there.
//
// Preconditions (asserted): `base` is not empty; fade as described; levels >= 0.
// Errors: out_of_memory, cancelled.
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] Result<MipChain> build_mip_chain(NormalMap base, const MipOptions& options = {},
                                               const Execution& execution = {});

}  // namespace tex
#pragma GCC visibility pop
