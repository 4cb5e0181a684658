// SPDX-License-Identifier: Apache-2.0
// parallax.h: finds where the view ray meets the height map.

#pragma once

#include <tex/preview.h>

#include "preview/sampling.h"

namespace tex::inline v1::render {

// Heights, of which `white` counts as 1.
struct Relief {
    const Sampler& heights;
    double white = 1.0;
};

// The offset of Parallax (preview.h) for a view direction in the tangent frame, view.z > 0.
[[nodiscard]] Vec2 parallax_offset(const Parallax& parallax, const Relief& relief, Vec2 uv, const Footprint& footprint,
                                   Vec3 view, int anisotropy);

}  // namespace tex::inline v1::render
