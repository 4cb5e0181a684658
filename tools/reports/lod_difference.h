// SPDX-License-Identifier: Apache-2.0
// lod_difference.h: how far simplified models are from their original to the eye.

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <tex/file.h>
#include <tex/mesh.h>
#include <tex/types.h>

namespace tex::cli {

// A material of a model with its normal map, ready to draw.
struct LodMaterial {
    std::string name;
    SelectedPart selected;  // where the scene places it
    MipChain map;           // times its scale; a flat one if it has none
};

// The materials that are on triangles with UVs and normals. Other meshes than
// glTF have no maps. Errors: those of read_model(), read_mesh(), read_map(), unpack().
[[nodiscard]] Result<std::vector<LodMaterial>> lod_materials(const std::string& model, const ReadOptions& options,
                                                             const Execution& execution);

// Adds a triangle without area to each, which nobody sees, so that all of them are drawn in one place and size.
void frame_together(const std::vector<std::vector<LodMaterial>*>& models);

// 26 of them: from the centre of a cube to its sides, edges and corners. Degrees, as in Camera.
struct LodView {
    float yaw = 0.0f, pitch = 0.0f;
};
[[nodiscard]] std::vector<LodView> lod_views();
// Towards the light, which stands over the left shoulder of the viewer.
[[nodiscard]] Float3 lod_light(const LodView& view);

// Pictures are `side` pixels wide. Pixels count that all models cover, at least so many pixels inside, and where the
// code of the original is at least that.
inline constexpr int kLodSide = 700, kLodInside = 2, kLodLit = 40;
// Which of side x side pixels are covered so far inside.
[[nodiscard]] std::vector<bool> far_inside(const std::vector<bool>& covered, int side);

struct LodDifference {
    double codes = 0.0;    // mean difference of lit codes, 0 to 255
    double degrees = 0.0;  // mean angle between the normals
};

// The difference of each LOD from the original: each material is drawn alone, by preview(), with its map and without
// its colours, from all views, and counts as many pixels as it has. All models are framed together. Materials belong
// together by name. No element if they have none in common. Errors: those of preview(), cancelled.
[[nodiscard]] Result<std::vector<LodDifference>> lod_differences(
    const std::vector<LodMaterial>& original, const std::vector<const std::vector<LodMaterial>*>& lods, int side,
    const Execution& execution);

}  // namespace tex::cli
