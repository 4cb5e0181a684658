// SPDX-License-Identifier: Apache-2.0
// convert_options.h: how an engine decodes a tangent-space normal map, and how maps are converted: see convert.h.

#pragma once

#include <string>
#include <vector>

#include <tex/mesh.h>
#include <tex/names.h>
#include <tex/result.h>

#pragma GCC visibility push(default)
namespace tex {

// How an engine makes the vectors T', B' and N' that decode a texel (see convert.h) from the normals N, the tangents T
// and the signs w of a triangle's corners. N and T are normalised at the corners first. Interpolation is linear in UV
// space.
//
//   per vertex     T' and N' are interpolated, B' is the interpolated w cross(N, T); nothing is normalised
//   per fragment   T' and N' are interpolated, B' = w cross(N', T'); nothing is normalised
//   normalized     as per vertex, but B is normalised at the corners, and T', B' and N' after interpolation
//
// Decoders of the same kind give the same vectors. Where engines differ in y, or in how exactly they store tangents,
// the decoders here do not: Unreal reads maps with y down and stores tangents in 8 bits by default. rebuilds_z() says
// which ones ignore z.
enum class DecoderKind { per_vertex, per_fragment, normalized };

inline constexpr Named<DecoderKind> kDecoderKindNames[] = {
    {DecoderKind::per_vertex, "per-vertex", "B is made at the vertices; nothing is normalised"},
    {DecoderKind::per_fragment, "per-fragment", "B is made at the fragment; nothing is normalised"},
    {DecoderKind::normalized, "normalized", "B is made at the vertices; T, B and N are normalised"},
};

enum class Decoder {
    unity_builtin,
    unity_urp,
    unity_hdrp,
    unreal,
    godot,
    gltf,
    blender,
    three,
    substance_vertex,
    substance_fragment,
};

inline constexpr Named<Decoder> kDecoderNames[] = {
    {Decoder::unity_builtin, "unity-builtin", "Unity's built-in pipeline, xNormal: per vertex"},
    {Decoder::unity_urp, "unity-urp", "Unity URP: per fragment"},
    {Decoder::unity_hdrp, "unity-hdrp", "Unity HDRP: per fragment"},
    {Decoder::unreal, "unreal", "Unreal: per fragment"},
    {Decoder::godot, "godot", "Godot: per vertex"},
    {Decoder::gltf, "gltf", "glTF's formula: per fragment"},
    {Decoder::blender, "blender", "Blender (Cycles): per fragment"},
    {Decoder::three, "three", "three.js: normalised per vertex and per fragment"},
    {Decoder::substance_vertex, "substance-vertex", "Substance, binormal per vertex"},
    {Decoder::substance_fragment, "substance-fragment", "Substance, binormal per fragment"},
};

[[nodiscard]] constexpr DecoderKind decoder_kind(Decoder decoder) {
    switch (decoder) {
        case Decoder::unity_builtin:
        case Decoder::godot:
        case Decoder::substance_vertex: return DecoderKind::per_vertex;
        case Decoder::three: return DecoderKind::normalized;
        case Decoder::unity_urp:
        case Decoder::unity_hdrp:
        case Decoder::unreal:
        case Decoder::gltf:
        case Decoder::blender:
        case Decoder::substance_fragment: break;
    }
    return DecoderKind::per_fragment;
}

// Whether the engine ignores the z of every texture, and takes sqrt(max(0, 1 - x^2 - y^2)) for it.
[[nodiscard]] constexpr bool rebuilds_z(Decoder decoder) { return decoder == Decoder::godot; }

// The tangent space of a map: a mesh with a tangent for each corner, and a decoder. Refers to the caller's objects.
struct TangentSpace {
    const MeshPart& part;
    const std::vector<Float4>& tangents;  // one for each element of part.indices
    int uv_set = 0;
    Decoder decoder = Decoder::gltf;
    std::string file = {};  // that errors name; may be empty
};

// The padding that fills the whole map.
inline constexpr int kPadAll = 1 << 30;

// The most subsamples of a texel in each direction.
inline constexpr int kMaxSubsamples = 8;

struct ConvertOptions {
    int padding = kPadAll;  // the width in texels of the border around each chart, 0 or more
    int subsamples = 1;     // of a texel, in each direction, 1 to kMaxSubsamples
};

// Whether every option is in its range. The verbs call it first. Errors: bad_option, which names the option.
[[nodiscard]] Result<void> validate(const ConvertOptions& options);

}  // namespace tex
#pragma GCC visibility pop
