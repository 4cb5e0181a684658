// SPDX-License-Identifier: Apache-2.0
// roughness.h: roughness maps that make up for the detail that renormalised mip levels lose.
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

#pragma once

#include <vector>

#include <tex/execution.h>
#include <tex/image.h>
#include <tex/mip.h>
#include <tex/normal_map.h>
#include <tex/pack.h>
#include <tex/result.h>
#include <tex/roughness_options.h>
#include <tex/texture.h>

#pragma GCC visibility push(default)
namespace tex {

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
[[nodiscard]] Result<RoughnessChain> build_roughness_chain(const NormalMap& base, const Plane<float>& roughness,
                                                           RoughnessModel model = RoughnessModel::toksvig,
                                                           const MipOptions& options = {},
                                                           const Execution& execution = {});

// The first channel holds roughness; no channel holds a component of a normal.
inline constexpr Swizzle kRoughnessSwizzle = {Component::other, Component::zero, Component::zero, Component::one};

// Packs a chain as a texture of one channel: bc4_unorm or eac_r11_unorm (with the guarantees of pack()), r8_unorm,
// r16_unorm (codes rounded as in format.h, of the value instead of (n + 1) / 2), r16_float or r32_float. Other formats
// give bad_option.
//
// Errors: bad_option, out_of_memory, cancelled.
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] Result<Texture> pack_roughness(const RoughnessChain& chain, Format format = Format::r8_unorm,
                                             Effort effort = Effort::normal, const Execution& execution = {});

}  // namespace tex
#pragma GCC visibility pop
