// SPDX-License-Identifier: Apache-2.0
// sampling.h: textures as a GPU samples them: trilinear and anisotropic.

#pragma once

#include <array>
#include <vector>

#include <tex/execution.h>
#include <tex/height_field.h>
#include <tex/image.h>
#include <tex/mip_chain.h>
#include <tex/result.h>

#include "preview/vector.h"

namespace tex::render {

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

// Planes with smaller levels of their own, made by a box filter that weighs what a texel covers.
class Pyramid {
public:
    // Precondition: 1 to kMaxChannels planes of one extent, which outlive the pyramid. Errors: cancelled,
    // out_of_memory.
    static Result<Pyramid> build(const std::vector<PlaneView<const float>>& base, const Execution& execution);

    [[nodiscard]] Sampler sampler(Wrap wrap_x, Wrap wrap_y) const;

private:
    std::vector<std::vector<PlaneView<const float>>> levels_;
    std::vector<Plane<float>> owned_;
};

// The footprint of a pixel: how (u, v) changes to the next pixel on the right and below.
struct Footprint {
    Vec2 dx, dy;
};

// Trilinear samples, up to `anisotropy` of them along the footprint's longer axis; averaged.
//
//     Px = |dx (w, h)|, Py = |dy (w, h)|          N = min(ceil(Pmax / Pmin), anisotropy)
//     level = log2(Pmax / N), clamped to the levels there are
//
// (EXT_texture_filter_anisotropic.) Texel centres lie at (i + 0.5) / w; v is 1 at the upper edge of the top row.
[[nodiscard]] Sample sample(const Sampler& sampler, Vec2 uv, const Footprint& footprint, int anisotropy);

}  // namespace tex::render
