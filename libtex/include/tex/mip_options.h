// SPDX-License-Identifier: Apache-2.0
// mip_options.h: how mip levels are made: see mip.h.

#pragma once

#include <optional>

#include <tex/height_field.h>
#include <tex/names.h>
#include <tex/result.h>
#include <tex/roughness_options.h>

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
enum class OtherKind { height, occlusion, mask, roughness, gloss };

inline constexpr Named<OtherKind> kOtherKindNames[] = {
    {OtherKind::height, "height", "smaller levels hold the mean"},
    {OtherKind::occlusion, "occlusion", "smaller levels hold the mean"},
    {OtherKind::mask, "mask", "smaller levels hold the mean"},
    {OtherKind::roughness, "roughness", "smaller levels get the variance that the normals lose"},
    {OtherKind::gloss, "gloss", "1 - roughness"},
};

// Whether smaller levels depend on the normals.
[[nodiscard]] constexpr bool follows_normals(OtherKind kind) {
    return kind == OtherKind::roughness || kind == OtherKind::gloss;
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
    OtherKind blue = OtherKind::mask;  // of the data beside the normals
    OtherKind alpha = OtherKind::mask;
    RoughnessModel roughness = RoughnessModel::toksvig;  // of roughness and gloss among them

    // Whether smaller levels of other data depend on the normals.
    [[nodiscard]] bool follow_normals() const { return follows_normals(blue) || follows_normals(alpha); }
};

// Whether every option is in its range. The verbs call it first. Errors: bad_option, which names the option.
[[nodiscard]] Result<void> validate(const MipOptions& options);

}  // namespace tex
#pragma GCC visibility pop
