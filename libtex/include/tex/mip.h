// SPDX-License-Identifier: Apache-2.0
// mip.h: mip chains, and roughness maps that make up for the detail that they lose.

#pragma once

#include <optional>
#include <vector>

#include <tex/types.h>

namespace tex::inline v1 {

// -- mip -----------------------------------------------------------------------------------------------------------
//
// Mip chains of normal maps, renormalised.

enum class RoughnessModel { toksvig, vmf };

inline constexpr Named<RoughnessModel> kRoughnessModelNames[] = {
    {RoughnessModel::toksvig, "toksvig", "all of the lost variance (Toksvig 2005)"},
    {RoughnessModel::vmf, "vmf", "a quarter of it, as in The Order: 1886 (von Mises-Fisher)"},
};

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
// 0, 1). Level `last` and all smaller levels are flat. 0 <= first < last.
struct Fade {
    int first = 1;
    int last = 3;
};

// What data beside the normals are (NormalMap::blue, NormalMap::alpha), and so how smaller levels get them.
//
//   height, occlusion, mask    the mean, by the filter of the normals
//   roughness                  as build_roughness_chain() does: with the variance that the averaged normals lose. Needs
//                              the domain vector
//   gloss                      1 - roughness, the same way
enum class ExtraKind { height, occlusion, mask, roughness, gloss };

inline constexpr Named<ExtraKind> kExtraKindNames[] = {
    {ExtraKind::height, "height", "smaller levels hold the mean"},
    {ExtraKind::occlusion, "occlusion", "smaller levels hold the mean"},
    {ExtraKind::mask, "mask", "smaller levels hold the mean"},
    {ExtraKind::roughness, "roughness", "smaller levels get the variance that the normals lose"},
    {ExtraKind::gloss, "gloss", "1 - roughness"},
};

// Whether smaller levels depend on the normals.
[[nodiscard]] constexpr bool follows_normals(ExtraKind kind) {
    return kind == ExtraKind::roughness || kind == ExtraKind::gloss;
}

struct MipOptions {
    int levels = 0;  // number of levels, counting the base level; 0, or more than there can be, is a complete chain
    MipFilter filter = MipFilter::box;
    MipDomain domain = MipDomain::vector;
    std::optional<Fade> fade;
    Wrap wrap_x = Wrap::repeat;  // clamp repeats the border texel, mirror does not flip vectors
    Wrap wrap_y = Wrap::repeat;
    // The longest side of levels[0] in texels; 0: no limit. Larger levels are made, as smaller ones come from them, and
    // left out. `levels` and `fade` count from the first level that is kept.
    int max_side = 0;
    // z may be negative, as in object space; else a z below 0 becomes 0. Needs the domain vector and no fade.
    bool any_z = false;
    ExtraKind blue = ExtraKind::mask;  // of the data beside the normals
    ExtraKind alpha = ExtraKind::mask;
    RoughnessModel roughness = RoughnessModel::toksvig;  // of roughness and gloss among them

    // Whether smaller levels of other data depend on the normals.
    [[nodiscard]] bool follow_normals() const { return follows_normals(blue) || follows_normals(alpha); }
};

// Whether every option is in its range. The verbs call it first. Errors: bad_option, which names the option.
[[nodiscard]] TEX_API Result<void> validate(const MipOptions& options);

// Builds the chain. Each level is filtered from the previous level before that one is normalised, so that a level is
// the true average of the base level. The stored vector is
//
//     normalize(lerp(normalize(average), (0, 0, 1), t))
//
// A z below 0 (from filters with negative lobes) becomes 0 first, unless any_z is set, and a vector shorter than 1e-6
// becomes (0, 0, 1). The base level is stored as given: t is 0 there. With
// options.max_side, levels[0] may be a smaller level.
//
// Errors: bad_option (the map has no texels; as validate(options)), out_of_memory, cancelled.
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] TEX_API Result<MipChain> build_mip_chain(NormalMap base, const MipOptions& options = {},
                                                       const Execution& execution = {});

// -- roughness -----------------------------------------------------------------------------------------------------
//
// Roughness maps that make up for the detail that renormalised mip levels lose.
//
// A level of a mip chain holds averages of vectors that disagree, so the averages are shorter than 1. Renormalising
// them discards the disagreement: from afar a bumpy surface becomes a smooth one, whose highlights are too small, too
// bright, and flicker. The length m of the average measures the disagreement, and a rougher material can show what the
// normals no longer show.
//
// Roughness is perceptual, as in glTF, Unity, Unreal and Filament: the width of the distribution of microfacets
// (Beckmann's and GGX's alpha) is
//
//     alpha = roughness^2
//
// The alpha' of a level follows from m and the alpha of the material itself, and roughness' = sqrt(alpha').
//
//   toksvig   A Blinn-Phong lobe of power s becomes one of power s' = s m / (m + s (1 - m)) (Toksvig: Mipmapping Normal
//             Maps, NVIDIA 2004 and Journal of Graphics Tools 2005). With s = 2 / alpha^2 - 2 (Walter et al.:
//             Microfacet Models for Refraction, 2007) that is
//
//                 alpha'^2 = (m alpha^2 + q) / (m + q),    q = 2 (1 - alpha^2) (1 - m)
//
//             On a mirror, small slopes with the variance v on either axis give alpha'^2 = 2 v: Beckmann's distribution
//             of exactly these slopes.
//
//   vmf       The vectors are treated as a von Mises-Fisher distribution (Han et al.: Frequency Domain Normal Map
//             Filtering, SIGGRAPH 2007), whose concentration kappa follows from m (Banerjee et al.: Clustering on the
//             Unit Hypersphere, 2005):
//
//                 kappa = (3 m - m^3) / (1 - m^2),    alpha'^2 = min(1, alpha^2 + 1 / (2 kappa))
//
//             as in Neubelt and Pettineo (Crafting a Next-Gen Material Pipeline for The Order: 1886, SIGGRAPH 2013, and
//             its sample) and in engines since. For the same vectors it adds a quarter of the variance that toksvig
//             adds: highlights stay tighter than those of the base level.
//
// Both give alpha if m is 1, and 1 if m is 0.

// Perceptual roughness, 0 to 1. levels[0] is the base level; extents are those of level_extent().
struct RoughnessChain {
    std::vector<Plane<float>> levels;
};

// The roughness of every level of the chain that build_mip_chain() makes of `base` with the same options.
//
// The base level is `roughness` as given; values are clamped to [0, 1], and NaN becomes 0. A map of another extent is
// stretched over the base: the filter halves its alpha^2 while it is at least twice as large along both axes, and then
// it is sampled bilinearly.
//
// For the smaller levels, options.filter averages vectors and alpha^2, each level from the averages of the previous
// one, with borders by options.wrap_x and wrap_y. m is the length of the averaged vector, and alpha^2 the average;
// both are clamped to [0, 1] (filters with negative lobes overshoot). alpha^2 is averaged, not roughness, because it
// is a variance: the variances of several lobes average, and that of the vectors is added (as with the moments of
// Olano, Baker: LEAN Mapping, I3D 2010). The vectors themselves are averaged in either options.domain. options.fade
// has no effect: flat levels lack the detail of their vectors too. If 1 - m^2 is below 2^-20, which is a difference of
// 0.06 degrees, it is the rounding of floats and counts as 0.
//
// Precondition: vectors have unit length (shorter ones count as averages).
// Errors: bad_option (`base` or `roughness` has no texels; as validate(options)), out_of_memory, cancelled.
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] TEX_API Result<RoughnessChain> build_roughness_chain(const NormalMap& base, const Plane<float>& roughness,
                                                                   RoughnessModel model = RoughnessModel::toksvig,
                                                                   const MipOptions& options = {},
                                                                   const Execution& execution = {});

}  // namespace tex::inline v1
