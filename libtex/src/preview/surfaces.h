// SPDX-License-Identifier: Apache-2.0
// surfaces.h: computes what each type of picture shows at a point of the shape.

#pragma once

#include <optional>

#include <tex/preview.h>

#include "preview/measures.h"
#include "preview/renderer.h"
#include "preview/sampling.h"
#include "preview/shading.h"

namespace tex::inline v1::render {

// The textures of a scene, prepared for sampling.
class Textures {
public:
    // Prepares the textures. Errors: bad_option (the albedo has no usable planes), cancelled, out_of_memory.
    static Result<Textures> prepare(const PreviewScene& scene, const PreviewOptions& options,
                                    const Execution& execution);

    Sampler map, detail, albedo, detail_albedo, height, occlusion;  // empty if there is none

private:
    std::optional<Pyramid> albedo_, detail_albedo_, height_, occlusion_;
};

// Whether z of the map is reconstructed: the texture has none, or the mesh's decoder ignores it.
[[nodiscard]] inline bool reconstructs_z(const PreviewScene& scene) {
    return scene.map_without_z || (scene.mesh != nullptr && rebuilds_z(scene.mesh->decoder));
}

// The whole material with lighting.
class LitSurface {
public:
    LitSurface(const Textures& textures, const PreviewScene& scene, const PreviewOptions& options, const Stage& stage);

    [[nodiscard]] Vec3 linear_light(const Hit& hit, const Footprint& footprint) const;
    // The perturbed normal in the space of the shape.
    [[nodiscard]] Vec3 normal(const Hit& hit, const Footprint& footprint) const;

private:
    [[nodiscard]] Hit displaced(const Hit& hit, const Footprint& footprint) const;
    [[nodiscard]] Vec3 tangent_normal(Vec2 uv, const Footprint& footprint) const;
    [[nodiscard]] Vec3 albedo(Vec2 uv, const Footprint& footprint) const;
    [[nodiscard]] Vec2 detail_place(Vec2 uv) const;
    [[nodiscard]] Footprint detail_area(const Footprint& footprint) const;

    const Textures& textures_;
    const PreviewScene& scene_;
    const PreviewOptions& options_;
    const Stage& stage_;
    Illumination with_;
};

}  // namespace tex::inline v1::render
