// SPDX-License-Identifier: Apache-2.0
// convert.h: converts normal maps between tangent space and object space, with the tangents of a mesh.
//
// An engine makes three vectors at each texel from a triangle's corners (`Decoder`), and decodes a texel t = (x, y, z)
// of the map, y up, with them:
//
//     n = normalize(x T' + y B' + z N')
//
// where z is rebuilt from x and y if the engine does so (rebuilds_z()). For it, x and y must be those of the texture:
// UnpackOptions::keep_length.
// Engines differ in these vectors, so a map decodes to other normals than it was made for, unless both are the same.
// to_tangent_space() is the exact inverse of to_object_space() for each decoder, of unit vectors with z >= 0:
//
//     r0 = cross(B', N'), r1 = cross(N', T'), r2 = cross(T', B'), s = the sign of dot(T', r0)
//     t = normalize(s (dot(n, r0), dot(n, r1), dot(n, r2)))
//
// A map in object space holds x, y and z of the mesh's own axes, which are those of the file: right-handed, with y up
// in glTF. z may be negative.

#pragma once

#include <cstdint>

#include <tex/convert_options.h>
#include <tex/execution.h>
#include <tex/image.h>
#include <tex/normal_map.h>
#include <tex/result.h>

#pragma GCC visibility push(default)
namespace tex {

// How a texel of a converted map got its normal.
enum class Coverage : std::uint8_t {
    none,      // it is background: (0, 0, 1)
    padding,   // it is a copy of the nearest texel that has a normal
    gutter,    // it continues the nearest triangle's plane (object space only)
    triangle,  // a triangle covers it
};

struct ConvertedMap {
    NormalMap map;
    Plane<Coverage> coverage;
    std::int64_t covered = 0;    // texels that triangles cover
    std::int64_t overlaps = 0;   // those (subsamples, if there are any) that several triangles cover: the first decides
    std::int64_t backward = 0;   // those whose z is negative in tangent space, so that most encodings cannot hold them
    std::int64_t singular = 0;   // those where T', B' and N' lie in one plane: they are (0, 0, 1) in tangent space
    std::int64_t unmatched = 0;  // refit() only: those that no triangle of the first space covers
};

// Converts a map.
//
// A texel belongs to the triangle whose UVs contain its centre; of two triangles that share an edge, exactly one does.
// The map repeats, so UVs may be outside of 0 to 1. Corners are rounded to 1/256 texel.
//
// With n subsamples, a texel is divided into n x n squares. Each belongs to a triangle as a texel does, and converts
// the texel's normal with its own T', B' and N'. The texel becomes the normalised sum of those that triangles cover,
// however few they are. Corners are then rounded to 1/256 square.
//
// The border of `padding` texels around the charts is filled afterwards. In object space, its first two texels (the
// gutter) are decoded from the map, with the nearest triangle continued beyond its edge; no weight of a corner goes
// beyond -1. All others are copies of the nearest texel. A map in object space often has no valid texels outside of its
// charts, so to_tangent_space() reads none of them: its border consists of copies alone.
//
// Data beside the normals (NormalMap::blue, alpha, length) stay where they are, as they are.
//
// Errors: bad_data     check_part(space.part) fails
//         bad_option   the map has no texels; as validate(options); no normals, no such set of UVs, not as many
//         tangents as corners; no triangle covers a texel unsupported  UVs beyond a million; a triangle covers more
//         than 16 repeats of the map, or more than 2^22
//                      texels, in one direction
//         out_of_memory, cancelled
// The same bytes for every number of threads, processor and compiler.
// Memory: 12 bytes for each texel of the result, 4 for each of its other data, and 1 for its coverage; 4 more while the
// border is filled; and about 80 bytes for each triangle.
[[nodiscard]] Result<ConvertedMap> to_object_space(const NormalMap& map, const TangentSpace& space,
                                                   const ConvertOptions& options = {}, const Execution& execution = {});
[[nodiscard]] Result<ConvertedMap> to_tangent_space(const NormalMap& map, const TangentSpace& space,
                                                    const ConvertOptions& options = {},
                                                    const Execution& execution = {});

// Makes a map in the tangent space `from` fit the tangent space `to`: another decoder, other tangents, or another
// version of the mesh with the same UVs. to_object_space() with `from`, padded, then to_tangent_space() with `to`.
// The counts are those of the second step. If charts share texels, the first triangle of each mesh decides.
//
// Errors and memory: as above, with two maps in memory besides `map`.
[[nodiscard]] Result<ConvertedMap> refit(const NormalMap& map, const TangentSpace& from, const TangentSpace& to,
                                         const ConvertOptions& options = {}, const Execution& execution = {});

}  // namespace tex
#pragma GCC visibility pop
