// SPDX-License-Identifier: Apache-2.0
// mesh_rule_rows.h: the rules about maps on meshes and in models, for rules.cpp.

#pragma once

#include "checks/rules.h"

namespace tex::inline v1 {
namespace mesh_rule_rows {

using enum RuleFamily;
using enum Severity;

inline constexpr Rule kMeshRules[] = {
    // -- the mesh ---------------------------------------------------------------------------------------------
    {"N701", "tangents-missing", mesh, note, true, "The mesh has a normal map, but no tangents.",
     "Each engine then makes its own tangents, and not all by MikkTSpace's method, as glTF asks. Cesium and filament "
     "light mirrored UVs, transforms or texCoord 1 from the wrong side then: normal-maps-engines(7) has a table. "
     "Models without any of these are not reported.",
     "Export the mesh with tangents, or make sure that the engine makes those that the map was baked with.", ""},
    {"N702", "tangents-not-unit", mesh, warning, true, "Tangents are not of unit length.",
     "A tangent of length zero has no direction, so its triangles are lit wrongly. Other lengths make bumps steeper or "
     "flatter in engines that do not normalise tangents. Triangles without area in the map cause this, and exporters "
     "that scale.",
     "Export the mesh again, with tangents that are made anew.", "N705"},
    {"N703", "tangent-sign-not-one", mesh, warning, true, "w of tangents is neither 1 nor -1.",
     "w is the side on which the bitangent lies. Engines multiply by it, so other values scale y, and 0 removes it.",
     "Export the mesh again, with tangents of four components.", ""},
    {"N704", "tangent-sign-mixed", mesh, warning, true, "w changes its sign within triangles.",
     "Between such corners the bitangent vanishes and turns around. Vertices at the border of mirrored charts must be "
     "split.",
     "Export the mesh again, with tangents that are made anew.", ""},
    {"N705", "tangents-not-mikktspace", mesh, note, true, "The tangents are not those of MikkTSpace.",
     "Maps from most bakers fit MikkTSpace's tangents. With others, the shading is wrong by the angle between both, "
     "unless the map was baked with these. A median of 60 degrees or more is an error: light seems to come from "
     "elsewhere in every engine. Blender makes them on quads, up to 11.6 degrees from those of the triangles that it "
     "exports: then a map that Blender baked fits the tangents of the file.",
     "If the map was baked for MikkTSpace on triangles, convert it with convert-normals --tangents-in mikktspace "
     "--tangents file. In Blender, triangulate the mesh before you bake and export it.",
     ""},
    {"N706", "tangent-sign-opposite", mesh, error, true, "w of tangents contradicts the UVs.",
     "In these triangles, the bitangent points down in the map. Bumps are lit from the wrong side there. Exporters "
     "that turn v around but not w cause this, and tools that drop w.",
     "Export the mesh again, with tangents that are made anew.", "N705 N711"},
    {"N707", "sign-and-green-cancel", mesh, note, true, "w of tangents and green are both the other way.",
     "w contradicts the UVs, and green points the other way than the engine reads it. The two cancel wherever the "
     "tangents of the file are used, and seams, if there are any, meet so. Engines that make their own tangents show "
     "dents as bumps.",
     "Change both or none: export new tangents, and turn green with pack-normals --y-in and --y.",
     "N401 N404 N705 N706"},
    {"N711", "other-tangent-space", mesh, error, true, "The map was made for another tangent space.",
     "The normals on both sides of UV seams are the same direction of the surface, so they must decode to the same "
     "vector in object space. They do so with another decoder, with other tangents, or if green points the other way. "
     "Seams and gradients show on the mesh. Reported only if the seams are clear enough to judge: the map was baked on "
     "this mesh, and its charts are not too small.",
     "Bake the map for this decoder and these tangents, or convert it with convert-normals --decoder-in, --tangents-in "
     "or --y-in.",
     ""},
    {"N721", "object-space-on-mesh", mesh, error, true, "The map is in object space.",
     "Its vectors follow the normals of the mesh instead of z. An engine that reads them in tangent space lights every "
     "side wrongly.",
     "Convert it with convert-normals --from object, or set the material to object space.", "N202 N207 N213 N402 N711"},
    {"N722", "charts-mirrored", mesh, note, true, "Charts are mirrored.",
     "Their corners are clockwise in the map, so w of their tangents is -1. That is fine if the engine uses w. Text "
     "and other details that have a left and a right are mirrored, too.",
     "", ""},
    {"N723", "charts-overlap", mesh, note, true, "Triangles share texels.",
     "Several places of the mesh show the same texels. That is fine for parts that are the same or mirrored. A map "
     "cannot hold another bump for each of them, and convert-normals and bakers let one triangle decide.",
     "", ""},
    {"N724", "padding-too-small", mesh, note, true, "The padding around charts is too small for mip levels.",
     "A texel of level n is the mean of 2^n by 2^n texels. Where the background or another chart is closer than that, "
     "it bleeds into the chart, and seams show at a distance. Levels down to a side of 128 texels are examined: 8 "
     "texels of padding suffice at 1024, 16 at 2048.",
     "Bake the map with more padding, and leave at least twice as much space between charts.", ""},
    {"N731", "quads-ambiguous", mesh, note, true, "Quads can be split in two ways that shade differently.",
     "A quad is drawn as two triangles, and normals are interpolated within each. If the baker splits it along the "
     "other diagonal than the engine, the map makes up for normals that the engine does not have: an X shows on the "
     "surface.",
     "Split the quads before baking, and export the same triangles to the engine.", ""},
    {"N801", "two-channel-in-model", model, error, true, "The image has two channels.",
     "glTF reads x, y and z of normals from R, G and B. BC5, EAC RG11 and other files of two channels give 0 for blue, "
     "which is z = -1. An engine that knows its own files may rebuild z; other readers of the model do not.",
     "pack-normals FILE --format SAME -o FIXED", ""},
    {"N802", "used-as-color", model, error, true, "The image is used as a colour, too.",
     "glTF reads colours as sRGB and normals as linear values. One image cannot be both: either the lighting or the "
     "colour is wrong.",
     "Give each slot of the material its own image.", ""},
    {"N803", "uv-set-missing", model, error, true, "The mesh lacks the set of UVs that the material names.",
     "Engines take another set, or (0, 0) everywhere, so the map does not show where it was made for.",
     "Correct texCoord of the material, or export the mesh with that set of UVs.", "N807"},
    {"N804", "scale-not-positive", model, warning, true, "The scale of the normal texture is not above 0.",
     "x and y are multiplied by it. A scale below 0 turns bumps into dents, and 0 makes the map flat.",
     "Set normalTexture.scale to a value above 0, and turn the heights of the map over if they are meant to be dents.",
     ""},
    {"N805", "double-sided-tangents", model, note, true, "A double-sided material is on a mesh with tangents.",
     "On back faces, glTF turns the normal over. Readers differ in whether the tangent turns with it: a bump is a dent "
     "from behind in three.js, Babylon.js, Cesium, filament and Blender, and a bump in PlayCanvas and Godot.",
     "Make the material single-sided, or look at both sides in each engine that is to show the model.", ""},
    {"N806", "data-in-normal-slot", model, error, true, "The image is used as other data, too.",
     "An image of occlusion, roughness or metalness holds no normals. Such images stand in the normal slot if slots "
     "were mixed up.",
     "Give each slot of the material its own image.", ""},
    {"N807", "mesh-not-examined", model, note, true, "The map was not examined on its mesh.",
     "Its triangles lack what tangent space needs, such as normals, so the rules for maps on meshes were left out.",
     "Export the mesh with normals and UVs.", ""},
    {"N808", "drawn-wrongly-by-engine", model, error, true,
     "An engine that is asked draws the map of this model wrongly.",
     "Engines make tangents in their own ways where the mesh has none, and treat nodes that mirror in their own ways. "
     "normal-maps-engines(7) has the table, drawn by the releases that it names. With --for gltf all of them are "
     "asked, "
     "and this is a warning.",
     "Export TANGENT for the UVs that the material reads, and apply scales that mirror to the meshes themselves.",
     "N701"},
};

}  // namespace mesh_rule_rows

using mesh_rule_rows::kMeshRules;

}  // namespace tex::inline v1
