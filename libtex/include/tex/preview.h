// SPDX-License-Identifier: Apache-2.0
// preview.h: pictures of normal maps, lit or in false colours.
//
// People judge a normal map by how it looks under a light. On the CPU, and with the same bytes everywhere, preview()
// renders what a GPU would show with the shaders of GLSL/Cg Programming in Unity (wikibook), "Lighting of Bumpy
// Surfaces" and "Projection of Bumpy Surfaces".
//
// World. x right, y up, z towards the viewer (right-handed). Light is computed in linear values and stored as sRGB
// (IEC 61966-2-1), rounded to the nearest code.

#pragma once

#include <tex/convert_options.h>
#include <tex/execution.h>
#include <tex/image.h>
#include <tex/mip_chain.h>
#include <tex/preview_options.h>
#include <tex/result.h>
#include <tex/texture.h>

#pragma GCC visibility push(default)
namespace tex {

// What is rendered. The chains must outlive the call. Precondition: `map` has a level; levels have the extents of
// level_extent().
struct PreviewScene {
    const MipChain* map = nullptr;     // sampled from its own levels; a single level is sampled without mip-mapping
    const MipChain* detail = nullptr;  // or none
    const Image* albedo = nullptr;     // or none: R, G, B or one grey plane, linear values; mip-mapped by a box filter
    const Image* detail_albedo = nullptr;  // or none; the same, sampled at the place of the detail
    const Plane<float>* height = nullptr;  // or none; mip-mapped by a box filter; integrate() finds those of a map
    float white = 1.0f;                    // the height that counts as 1 in Parallax, above 0

    // None, or the mesh that carries the map, instead of PreviewOptions::shape. It must outlive the call.
    const TangentSpace* mesh = nullptr;

    // The texture stores only x and y (DXT5nm, BC5): z is reconstructed from the filtered x and y, as in the shader.
    // Otherwise x, y and z are filtered, and the result is normalised. If the mesh's decoder ignores z (rebuilds_z()),
    // so does the picture.
    bool map_without_z = false;
    bool detail_without_z = false;
};

// Renders one picture: rgb8, one level, sRGB.
//
// Lighting (wikibook, "Lighting of Bumpy Surfaces") of a pixel, with N the perturbed normal, L the direction to the
// light and V the direction to the viewer:
//
//     N         = normalize(n.x T + n.y B + n.z N_shape)
//     a         = 1 for directional light, 1 / distance for a point light
//     R         = 2 (N.L) N - L
//     specular  = 0 if N.L < 0, else max(0, R.V)^shininess  (blinn: max(0, N.normalize(L + V))^shininess)
//     color     = ambient albedo + a light (albedo max(0, N.L) + specular_color specular)
//
// Filtering is trilinear between the map's levels. The footprint of the pixel in the texture (Heckbert 1989) comes from
// the neighbouring view rays, with up to `anisotropy` trilinear samples along its longer axis
// (EXT_texture_filter_anisotropic). Pixels on the outline of a shape are averaged from 16 rays.
//
// Meshes. The picture shows the mesh from outside of its sphere: the centre of its box becomes the origin, and the
// farthest corner is 1 away from it. Triangles hide each other by depth; those whose corners are clockwise in the
// picture face away and are not drawn, as in engines. At each pixel, N, B and T are N', B' and T' of the mesh's decoder
// (convert_options.h), at the place where the view ray meets the triangle. Of 16 places in a pixel, those on the same
// triangle share the light at their centre, and the pixel is their average. Corners are rounded to 1/256 pixel.
//
//   lines of `tangents`   as long as a mean edge, but 0.03 to 0.15, and raised by a tenth of that along N; at most 4096
//                         vertices, evenly spread. Only vertices of triangles that face the viewer.
//   edges of `seams`      two triangles share their ends, with smooth normals there but other UVs. Each has up to 8
//                         parts, with the error at their middles. Of more than 2^14 edges, as many, evenly spread.
//   triangles of `uv`     repeat with the map, if they leave it. If several cover a pixel, the first is shown.
//
// Preconditions (asserted): check_part(scene.mesh->part) succeeds.
// Errors: bad_option   the show is height but there is no height map; the albedo has neither R, G and B nor one plane;
//                      an option is outside the range stated beside it; the show is tangents, uv or seams but there is
//                      no mesh; the mesh has no normals, no such set of UVs, not as many tangents as corners
//         unsupported  triangles of a mesh hide each other more than 1024 deep, on average; UVs of `uv` are beyond a
//                      million, or triangles more than 16 repeats of the map long, or more than 4 on average
//         out_of_memory, cancelled
// Memory of a mesh: 16 bytes for each vertex and about 40 for each triangle (uv: 100, seams: 200).
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] Result<Texture> preview(const PreviewScene& scene, const PreviewOptions& options = {},
                                      const Execution& execution = {});

}  // namespace tex
#pragma GCC visibility pop
