// SPDX-License-Identifier: Apache-2.0
// sampling.h: samples textures as a GPU does: trilinear and anisotropic.

#pragma once

#include <array>
#include <vector>

#include <tex/height.h>
#include <tex/types.h>

#include "preview/vector.h"

namespace tex::inline v1::render {

inline constexpr int kMaxChannels = 3;
using Sample = std::array<double, kMaxChannels>;

// A view of the planes of a mip chain: levels[k][c] is channel c of level k.
struct Sampler {
    std::vector<std::vector<PlaneView<const float>>> levels;
    int channels = 0;
    Wrap wrap_x = Wrap::repeat, wrap_y = Wrap::repeat;

    [[nodiscard]] bool empty() const { return levels.empty(); }
    [[nodiscard]] Extent extent() const { return levels[0][0].extent; }
};

[[nodiscard]] Sampler sampler_of(const MipChain& chain, Wrap wrap_x, Wrap wrap_y);

// Planes with their smaller levels, made by a box filter that weights each texel by the part of it that is covered.
class Pyramid {
public:
    // Precondition: 1 to kMaxChannels planes of one extent, which must outlive the pyramid. Errors: cancelled,
    // out_of_memory.
    static Result<Pyramid> build(const std::vector<PlaneView<const float>>& base, const Execution& execution);

    [[nodiscard]] Sampler sampler(Wrap wrap_x, Wrap wrap_y) const;

private:
    std::vector<std::vector<PlaneView<const float>>> levels_;
    std::vector<Plane<float>> owned_;
};

// The footprint of a pixel: the change of (u, v) to the next pixel on the right and to the next one below.
struct Footprint {
    Vec2 dx, dy;
};

// Takes trilinear samples, up to `anisotropy` of them along the footprint's longer axis, and averages them.
//
//     Px = |dx (w, h)|, Py = |dy (w, h)|          N = min(ceil(Pmax / Pmin), anisotropy)
//     level = log2(Pmax / N), clamped to the existing levels
//
// (EXT_texture_filter_anisotropic.) Texel centres lie at (i + 0.5) / w; v is 1 at the upper edge of the top row.
[[nodiscard]] Sample sample(const Sampler& sampler, Vec2 uv, const Footprint& footprint, int anisotropy);

}  // namespace tex::inline v1::render
