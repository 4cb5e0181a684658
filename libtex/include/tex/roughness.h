// SPDX-License-Identifier: Apache-2.0
// roughness.h: roughness maps that make up for what renormalised mip levels lose.
//
// A level of a mip chain holds averages of vectors that do not agree, and so are shorter than 1. Renormalising them
// throws the disagreement away: from afar a bumpy surface turns into a smooth one, whose highlights are too small, too
// bright, and flicker. The length m of the average measures the disagreement, and a rougher material can show what the
// normals no longer do.
//
// Roughness is perceptual, as in glTF, Unity, Unreal and Filament: the width of the distribution of microfacets
// (Beckmann's and GGX's alpha) is
//
//     alpha = roughness^2
//
// From m and the alpha that the material itself has come the alpha' of a level, and roughness' = sqrt(alpha').
//
//   toksvig   A Blinn-Phong lobe of power s becomes one of power s' = s m / (m + s (1 - m)) (Toksvig: Mipmapping Normal
//   Maps, NVIDIA 2004 and
//             Journal of Graphics Tools 2005). With s = 2 / alpha^2 - 2 (Walter et al.: Microfacet Models for
//             Refraction, 2007) that is
//
//                 alpha'^2 = (m alpha^2 + q) / (m + q),    q = 2 (1 - alpha^2) (1 - m)
//
//             On a mirror small slopes with the variance v on either axis give alpha'^2 = 2 v: Beckmann's distribution
//             of just these slopes.
//
//   vmf       The vectors are taken for a von Mises-Fisher distribution (Han et al.: Frequency Domain Normal Map
//   Filtering, SIGGRAPH 2007), whose
//             concentration kappa follows from m (Banerjee et al.: Clustering on the Unit Hypersphere, 2005):
//
//                 kappa = (3 m - m^3) / (1 - m^2),    alpha'^2 = min(1, alpha^2 + 1 / (2 kappa))
//
//             as Neubelt and Pettineo had it (Crafting a Next-Gen Material Pipeline for The Order: 1886, SIGGRAPH 2013,
//             and its sample) and engines since. It adds a quarter of the variance that toksvig does for the same
//             vectors: highlights stay tighter than those of the base level.
//
// Both give alpha where m is 1, and 1 where it is 0.

#pragma once

#include <vector>

#include <tex/execution.h>
#include <tex/image.h>
#include <tex/mip.h>
#include <tex/names.h>
#include <tex/normal_map.h>
#include <tex/pack.h>
#include <tex/result.h>
#include <tex/texture.h>

#pragma GCC visibility push(default)
namespace tex {

enum class RoughnessModel { toksvig, vmf };

inline constexpr Named<RoughnessModel> kRoughnessModelNames[] = {
    {RoughnessModel::toksvig, "toksvig", "all of the lost variance (Toksvig 2005)"},
    {RoughnessModel::vmf, "vmf", "a quarter of it, as in The Order: 1886 (von Mises-Fisher)"},
};

// Perceptual roughness, 0 to 1. levels[0] is the base level; extents are those of level_extent().
struct RoughnessChain {
    std::vector<Plane<float>> levels;
};

// The roughness of every level of the chain that build_mip_chain() makes of `base` with the same options.
//
// The base level is `roughness` as given, values beyond 0 to 1 cut to it and NaN made 0. A map of another extent is
// stretched over the base: its alpha^2 is halved by the filter while it is at least twice as large along both axes, and
// then sampled bilinearly. Below it, vectors and alpha^2 are averaged by options.filter, each level from the averages
// of the one before, borders as options.wrap_x and wrap_y say; m is the length of the averaged vector and alpha^2 the
// average, both cut to [0, 1] (filters with negative lobes overshoot). alpha^2 and not roughness is averaged because it
// is a variance: those of several lobes average, and that of the vectors comes on top (as the moments of Olano, Baker:
// LEAN Mapping, I3D 2010). Vectors are averaged as such in either options.domain, and options.fade does not matter:
// flat levels lack what their vectors said as well. 1 - m^2 below 2^-20, vectors that differ by 0.06 degrees, is the
// rounding of floats and counts as 0.
//
// Preconditions (asserted): `base` is not empty, its vectors are of unit length (shorter ones count as averages),
// `roughness` is not empty; options as in build_mip_chain(). Errors: out_of_memory, cancelled. The same bytes for every
// number of threads, processor and compiler.
[[nodiscard]] Result<RoughnessChain> build_roughness_chain(const NormalMap& base, const Plane<float>& roughness,
                                                           RoughnessModel model = RoughnessModel::toksvig,
                                                           const MipOptions& options = {},
                                                           const Execution& execution = {});

// The roughness is in the first channel, and that of no normal.
inline constexpr Swizzle kRoughnessSwizzle = {Component::other, Component::zero, Component::zero, Component::one};

// Packs a chain as a texture of one channel: bc4_unorm (with the same promises as pack()), r8_unorm, r16_unorm (codes
// rounded as in format.h, of the value instead of (n + 1) / 2), r16_float or r32_float. Other formats give bad_option.
//
// Errors: bad_option, out_of_memory, cancelled.
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] Result<Texture> pack_roughness(const RoughnessChain& chain, Format format = Format::r8_unorm,
                                             Effort effort = Effort::normal, const Execution& execution = {});

}  // namespace tex
#pragma GCC visibility pop
