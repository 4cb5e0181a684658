// SPDX-License-Identifier: Apache-2.0
// mesh_gl.h: a mesh with a normal map under a light, drawn by Mesa's software OpenGL with a depth buffer.

#pragma once

#include <vector>

#include <tex/mesh.h>
#include <tex/types.h>

#include "wikibook_gl.h"

namespace peers {

// How a shader makes the binormal.
enum class Binormal { per_vertex, per_fragment, normalized };

// The view and the light of `scene`; its picture, map and material. The mesh is moved by -centre, then scaled.
struct GlMesh {
    const tex::TangentSpace* space = nullptr;
    Vec3 centre;
    float scale = 1.0f;
    Binormal binormal = Binormal::per_fragment;
};

// RGBA of the picture, rows from the top: linear light, and 1 in A where a triangle was drawn; elsewhere 0. Empty where
// OpenGL reported an error.
std::vector<float> draw_mesh(const GlScene& scene, const GlMesh& mesh);

}  // namespace peers
