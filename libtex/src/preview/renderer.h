// SPDX-License-Identifier: Apache-2.0
// renderer.h: computes every pixel of a picture of a shape.

#pragma once

#include <functional>

#include <tex/preview.h>

#include "preview/sampling.h"
#include "preview/shapes.h"

namespace tex::inline v1::render {

class MeshBody;

// Shape, camera and light in the space of the shape: `spin` rotates the viewer and the light the other way.
struct Stage {
    Body body;
    const MeshBody* mesh = nullptr;  // instead of the body, if there is one; the body is a sphere then
    View view;
    Extent size;
    Vec3 light;                                 // direction or position
    double spin_sine = 0.0, spin_cosine = 1.0;  // of a shape that spins; 0 and 1 for a plane

    // Transforms a direction from the space of the shape to the world.
    [[nodiscard]] Vec3 to_world(Vec3 v) const { return turn_about_y(v, spin_sine, spin_cosine); }
};

// For a mesh, options.shape is sphere.
[[nodiscard]] Stage stage(const PreviewOptions& options, const MeshBody* mesh, Extent map, Extent size);

// The values of a pixel that shows the shape: linear light or display values.
enum class Space { linear, display };
using Surface = std::function<Vec3(const Hit& hit, const Footprint& footprint)>;

// Renders the picture. Errors: unsupported (a mesh, as preview() says), out_of_memory, cancelled.
[[nodiscard]] Result<Texture> render(const Stage& stage, Space space, const Surface& surface,
                                     const Execution& execution);

}  // namespace tex::inline v1::render
