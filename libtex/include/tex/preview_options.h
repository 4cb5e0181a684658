// SPDX-License-Identifier: Apache-2.0
// preview_options.h: what a picture of a normal map shows: the shape, the light, the material, the camera. See
// preview.h.

#pragma once

#include <optional>

#include <tex/height_field.h>
#include <tex/image.h>
#include <tex/names.h>
#include <tex/normal_map.h>

#pragma GCC visibility push(default)
namespace tex {

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
//   curvature      the mean curvature (curvature.h) in 1/texel: bumps and edges     + and -
//                  brown, dents and grooves blue
//   channels       x, y (+ and -) and z (0 to 1) side by side
//   mips           all levels side by side, (n + 1) / 2
//   height         the heights, from the lowest value (black) to the highest (white)
//
// Of a mesh only (see "Meshes" in preview.h):
//
//   tangents       the tangent T (red), binormal B = w cross(N, T) (blue) and normal N (green) of vertices as lines, in
//                  the colours of Catlike Coding's TangentSpaceVisualizer, over the mesh without the map
//   uv             the triangles over the map, where their UVs place them; triangles with mirrored UVs in orange
//   seams          UV seams in the colours of the angle between the normals that the map decodes to on both sides, over
//                  the mesh without the map                                           0 to a rounded 99th percentile
//
// Values from 0 upwards are shown in viridis; values of both signs are shown in blue, white and red-brown. Both order
// colours by lightness or by blue against orange, which people with any common colour vision deficiency can read. A
// legend is below the picture. It has 240 steps (grey has all codes); values beyond its ends take the colour of the
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
[[nodiscard]] bool needs_mesh(Show show);

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

}  // namespace tex
#pragma GCC visibility pop
