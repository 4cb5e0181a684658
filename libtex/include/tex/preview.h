// SPDX-License-Identifier: Apache-2.0
// preview.h: maps are lit, and pictures put side by side.

#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <tex/format.h>
#include <tex/mesh.h>
#include <tex/types.h>

namespace tex::inline v1 {

// -- preview -------------------------------------------------------------------------------------------------------
//
// Pictures of normal maps, lit or in false colours.
//
// People judge a normal map by how it looks under a light. On the CPU, and with the same bytes everywhere, preview()
// renders what a GPU would show with the shaders of GLSL/Cg Programming in Unity (wikibook), "Lighting of Bumpy
// Surfaces" and "Projection of Bumpy Surfaces".
//
// World. x right, y up, z towards the viewer (right-handed). Light is computed in linear values and stored as sRGB
// (IEC 61966-2-1), rounded to the nearest code.

// What a picture shows. n = (x, y, z) is the stored normal of a texel, p = -x/z and q = -y/z are its slopes (z at least
// 1/256).
//
//   lit            the whole material under the light: see "Lighting" below
//   plain          the same without albedo, detail and parallax: the map alone
//   normals        the colours of the map with y up, (n + 1) / 2
//   world-normals  the perturbed normal N of the shape in world space, (N + 1) / 2
//   slope          sqrt(p^2 + q^2), rise per texel                                   0 to a rounded 99.5th percentile
//   tilt           angle between n and (0, 0, 1) in degrees                          0 to a rounded 99.9th percentile
//   length         |n| - 1: damage, or filtering without renormalisation             + and -
//   z-error        z - reconstruct_z(x, y): z that does not belong to x and y        + and -
//   curl           dq/dx - dp/dy, differences of neighbours: 0 for the normals of    + and -
//                  a height field, large if green is flipped. r in the legend is the
//                  correlation that check() measures: 1 with y up, -1 with y down
//   curvature      the mean curvature (surface.h) in 1/texel: bumps and edges     + and -
//                  brown, dents and grooves blue
//   channels       x, y (+ and -) and z (0 to 1) side by side
//   mips           all levels side by side, (n + 1) / 2
//   height         the heights, from the lowest value (black) to the highest (white)
//
// Of a mesh only (see "Meshes" below):
//
//   tangents       the tangent T (red), binormal B = w cross(N, T) (blue) and normal N (green) of vertices as lines, in
//                  the colours of Catlike Coding's TangentSpaceVisualizer, over the mesh without the map
//   uv             the triangles over the map, where their UVs place them; triangles with mirrored UVs in orange
//   seams          UV seams in the colours of the angle between the normals that the map decodes to on both sides, over
//                  the mesh without the map                                           0 to a rounded 99th percentile
//
// Values from 0 upwards are shown in viridis; values of both signs are shown in blue, white and red-brown. Both order
// colours by lightness or by blue against orange, which people with any common colour vision deficiency can read. The
// legend below the picture shows 240 colours; grey scales show all 256. Values beyond its ends take the colour of the
// end, and NaN is magenta.
enum class Show {
    lit,
    plain,
    normals,
    world_normals,
    slope,
    tilt,
    length,
    z_error,
    curl,
    curvature,
    channels,
    mips,
    height,
    tangents,
    uv,
    seams,
};

inline constexpr Named<Show> kShowNames[] = {
    {Show::lit, "lit", "the whole material under the light"},
    {Show::plain, "plain", "lit, the map alone: no albedo, detail or parallax"},
    {Show::normals, "normals", "the colours of the map, y up"},
    {Show::world_normals, "world-normals", "the shape's perturbed normals in world space"},
    {Show::slope, "slope", "steepness, rise per texel"},
    {Show::tilt, "tilt", "angle to the surface's own normal, degrees"},
    {Show::length, "length", "length of the stored vector minus 1"},
    {Show::z_error, "z-error", "stored z minus the z that x and y imply"},
    {Show::curl, "curl", "what no height field has; large where green is upside down"},
    {Show::curvature, "curvature", "how much the surface bends: bumps and dents, 1/texel"},
    {Show::channels, "channels", "x, y and z beside each other"},
    {Show::mips, "mips", "all levels beside each other"},
    {Show::height, "height", "the height map, or the heights that the normals show, in grey"},
    {Show::tangents, "tangents", "of a mesh: tangents, binormals and normals as lines"},
    {Show::uv, "uv", "of a mesh: its triangles over the map"},
    {Show::seams, "seams", "of a mesh: the error along UV seams, degrees"},
};

// Whether a picture shows the mesh itself, so that there must be one (PreviewScene::mesh).
[[nodiscard]] TEX_API bool needs_mesh(Show show);

// The shape that carries the map, if that is no mesh.
//
//   plane    2 high, as wide as the proportions of the map (and its tiles) require, in z = 0; u to the right, v up
//   sphere   radius 1; the map's centre faces +z, u runs east and v north; a map of w x h texels repeats
//            max(1, round(2 h / w)) times around it, so that texels are nearly square at the equator
//   cube     edges of 1.4; every face shows the whole map, upright on the four sides
//
// Tangent frame at every point: N the outward normal, T the direction of growing u, and the binormal
// B = cross(N, T) w, the direction of growing v; w is 1, or -1 if the UVs are mirrored.
enum class Shape { plane, sphere, cube };

inline constexpr Named<Shape> kShapeNames[] = {
    {Shape::plane, "plane", "a plane that fills the picture"},
    {Shape::sphere, "sphere", "a sphere, the map twice around it"},
    {Shape::cube, "cube", "a cube, the map on every face"},
};

enum class LightKind { directional, point };

inline constexpr Named<LightKind> kLightKindNames[] = {
    {LightKind::directional, "directional", "parallel light; the vector points to the light"},
    {LightKind::point, "point", "a light at a place; weakens with 1 / distance"},
};

enum class SpecularModel { phong, blinn };

inline constexpr Named<SpecularModel> kSpecularModelNames[] = {
    {SpecularModel::phong, "phong", "max(0, R.V)^shininess, R the reflected light (Phong 1975)"},
    {SpecularModel::blinn, "blinn", "max(0, N.H)^shininess, H halfway between light and view (Blinn 1977)"},
};

// Linear light, 1 is white.
struct Rgb {
    float r = 0.0f, g = 0.0f, b = 0.0f;
};

struct Light {
    LightKind kind = LightKind::directional;
    float x = -0.8f, y = 1.0f, z = 1.2f;  // direction to the light (any length above 0), or its position
    Rgb color = {1.0f, 1.0f, 1.0f};       // >= 0
};

struct Material {
    Rgb albedo = {0.6f, 0.6f, 0.6f};  // multiplies the albedo map, if there is one
    Rgb specular = {0.25f, 0.25f, 0.25f};
    float shininess = 20.0f;  // above 0
    SpecularModel model = SpecularModel::phong;
};

// The camera orbits the origin, looks at it, and is so far away that the whole shape is in the picture. A plane seen
// straight on (yaw and pitch 0) fills a picture that has its proportions exactly, so that texels and pixels coincide if
// their numbers are equal; the eye is then at (0, 0, 1 / tan(field_of_view / 2)).
struct Camera {
    float yaw = 0.0f;             // degrees to the right
    float pitch = 0.0f;           // degrees up, -89 to 89
    float field_of_view = 30.0f;  // vertical angle of view in degrees, 0 to 120; 0 is a parallel projection
};

// Detail, as in Catlike Coding, Rendering 6, 3: sampled at uv * tiling + offset, scaled, then blended over the map by
// whiteout, normalize(n1.xy + n2.xy, n1.z n2.z). The detail's albedo, sampled at the same place, is multiplied with the
// albedo and with 4.5948, so that sRGB grey 0.5 changes nothing (unity_ColorSpaceDouble).
struct Detail {
    float tiling_x = 1.0f, tiling_y = 1.0f;
    float offset_x = 0.0f, offset_y = 0.0f;
    float scale = 1.0f;  // the detail's bump scale
};

// Parallax mapping (Kaneko et al. 2001; Welsh 2004; wikibook, "Projection of Bumpy Surfaces"). V is the unnormalised
// direction to the viewer in the tangent frame (T, B, N), h the height at uv, in units of PreviewScene::white:
//
//     offset = clamp(P (h - 0.5) V.xy / V.z, -L, L)          one step: steps = 0
//
// With steps N >= 1 the view ray marches through the height map (relief mapping: Policarpo, Oliveira, Comba 2005). At
// height t its offset is P (t - 0.5) V.xy / V.z, clamped to +-L. t falls from 1 to 0 in N equal steps until the height
// map there reaches t, and the crossing is interpolated between the last two steps. All maps are then sampled at uv +
// offset.
struct Parallax {
    float amount = 0.0f;  // P: height of value 1.0 in texture widths; negative makes white low
    float limit = 0.1f;   // L >= 0, in texture widths
    int steps = 0;        // 0 to 1024
};

struct PreviewOptions {
    Show show = Show::lit;
    // Pixels without the legend, at most 16384 a side. {n, 0}: n is the longer side, in the proportions of the plane
    // (sphere and cube: square). {0, 0}: on a plane the map's extent times the tiles, with the longer side at most
    // 1024; otherwise 512x512. The picture of `uv` has the proportions of the map.
    Extent size;

    Shape shape = Shape::plane;
    int tiles_x = 1, tiles_y = 1;  // how often the map repeats on a plane, 1 to 256
    bool mirror = false;           // u runs from right to left on the whole shape: T is reversed, and w is -1
    // Degrees: a sphere, cube or mesh turns to the right about its vertical axis; over a plane the light circles.
    float spin = 0.0f;

    std::optional<Camera> camera;  // none: straight on; a cube from yaw -35, pitch 25; a mesh from 30, 20
    Light light;
    Rgb ambient = {0.03f, 0.03f, 0.03f};
    Material material;
    float bump_scale = 1.0f;
    ScaleMode scale_mode = ScaleMode::slope;  // of bump_scale and detail.scale
    Detail detail;
    Parallax parallax;

    Wrap wrap_x = Wrap::repeat;  // of all maps; clamp repeats the border texel
    Wrap wrap_y = Wrap::repeat;
    int anisotropy = 8;  // maximum of samples along a texel's long axis, 1 to 16; 1 is only trilinear filtering

    float maximum =
        0.0f;  // the legend's upper end for slope, tilt, length, z_error, curl, curvature, seams; 0: automatic
    bool legend = true;  // below false colours and mips; makes the picture higher
};

// Whether every option is in its range. Errors: bad_option, which names the option.
[[nodiscard]] TEX_API Result<void> validate(const PreviewOptions& options);

// What is rendered. The chains must outlive the call. Precondition: `map` has a level; levels have the extents of
// level_extent().
struct PreviewScene {
    const MipChain* map = nullptr;     // sampled from its own levels; a single level is sampled without mip-mapping
    const MipChain* detail = nullptr;  // or none
    const Image* albedo = nullptr;     // or none: R, G, B or one grey plane, linear values; mip-mapped by a box filter
    const Image* detail_albedo = nullptr;     // or none; the same, sampled at the place of the detail
    const Plane<float>* height = nullptr;     // or none; mip-mapped by a box filter; integrate() finds those of a map
    float white = 1.0f;                       // the height that counts as 1 in Parallax, above 0
    const Plane<float>* occlusion = nullptr;  // or none: 1 is open, 0 closed; mip-mapped by a box filter

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
//     color     = ambient occlusion albedo + a light (albedo max(0, N.L) + specular_color specular)
//
// Filtering is trilinear between the map's levels. The footprint of the pixel in the texture (Heckbert 1989) comes from
// the neighbouring view rays, with up to `anisotropy` trilinear samples along its longer axis
// (EXT_texture_filter_anisotropic). Pixels on the outline of a shape are averaged from 16 rays.
//
// Meshes. The picture shows the mesh from outside of its sphere: the centre of its box becomes the origin, and the
// farthest corner is 1 away from it. Triangles hide each other by depth; those whose corners are clockwise in the
// picture face away and are not drawn, as in engines. At each pixel, N, B and T are N', B' and T' of the mesh's decoder
// (mesh.h), at the place where the view ray meets the triangle. Of 16 places in a pixel, those on the same
// triangle share the light at their centre, and the pixel is their average. Corners are rounded to 1/256 pixel.
//
//   lines of `tangents`   as long as a mean edge, but 0.03 to 0.15, and raised by a tenth of that along N; at most 4096
//                         vertices, evenly spread. Only vertices of triangles that face the viewer.
//   edges of `seams`      two triangles share their ends, with smooth normals there but other UVs. Each has up to 8
//                         parts, with the error at their middles. Of more than 2^14 edges, as many, evenly spread.
//   triangles of `uv`     repeat with the map, if they leave it. If several cover a pixel, the first is shown.
//
// Errors: bad_option   the show is height but there is no height map; the albedo has neither R, G and B nor one plane;
//                      as validate(options); the show is tangents, uv or seams but there is
//                      no mesh; the mesh has no normals, no such set of UVs, not as many tangents as corners
//         unsupported  triangles of a mesh hide each other more than 1024 deep, on average; UVs of `uv` are beyond a
//                      million, or triangles more than 16 repeats of the map long, or more than 4 on average
//         out_of_memory, cancelled
// Memory of a mesh: 16 bytes for each vertex and about 40 for each triangle (uv: 100, seams: 200).
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] TEX_API Result<Texture> preview(const PreviewScene& scene, const PreviewOptions& options = {},
                                              const Execution& execution = {});

// -- sheet ---------------------------------------------------------------------------------------------------------
//
// Combines pictures into contact sheets, split views and animations.

// Here, a picture is a texture as preview() makes it: rgb8, one level, sRGB.

// The planes R, G and B of an image (for example a heat_map()), which are sRGB values from 0 to 1, as a picture:
// floor(255 c + 0.5), clamped. Errors: bad_option (a plane is missing), out_of_memory.
[[nodiscard]] TEX_API Result<Texture> picture_of(const Image& image);

// The bytes of a PNG of the picture, with the fewest channels that hold its colours: grey if R, G and B are equal
// everywhere, a palette if there are at most 256 colours (preview()'s false colours), else R, G, B. Errors:
// out_of_memory.
[[nodiscard]] TEX_API Result<std::vector<std::byte>> encode_picture(const Texture& picture);

// A picture with a caption: a part of a sheet.
struct Panel {
    Texture picture;        // without a level: an empty cell
    std::string caption;    // printable ASCII; other bytes show as a box; if it is too long, its middle is left out
    std::string note = {};  // written into an empty cell: why it is empty
};

// Panels in rows of `columns` (0: about as many rows as columns) on a dark background, each with its caption below.
// Cells are as large as the largest panel of their column and row; empty ones are as large as the largest picture of
// the sheet, or 320x320. Errors: bad_option (the list is empty), out_of_memory.
[[nodiscard]] TEX_API Result<Texture> contact_sheet(const std::vector<Panel>& panels, int columns = 0);

// The left half of `left` and the right half of `right`, with a line between them and both captions. Errors: bad_option
// (the extents differ), out_of_memory.
[[nodiscard]] TEX_API Result<Texture> split_view(const Panel& left, const Panel& right);

// The bytes of an animated PNG that repeats the pictures forever, at `frames_per_second` (1 to 1000). Programs without
// support for animation show the first picture. Errors: bad_option (no picture, or pictures that differ in size),
// out_of_memory.
[[nodiscard]] TEX_API Result<std::vector<std::byte>> encode_animation(const std::vector<Texture>& pictures,
                                                                      int frames_per_second = 20);

}  // namespace tex::inline v1
