// SPDX-License-Identifier: Apache-2.0

#include "blend_gl.h"

#include "software_gl.h"

namespace peers {
namespace {

// BlendNormals of Unity's shader library, on maps that a shader samples at uv * _ST.xy + _ST.zw. The level is that of
// the OpenGL specification (4.6, 8.14.1), written out: llvmpipe's own has a logarithm that is off by up to 0.09.
constexpr const char* kFragmentShader = R"(#version 330 core
uniform sampler2D base, detail;
uniform vec2 extent, tiling, offset;
uniform float baseScale, detailScale;
out vec4 result;
vec3 scaled(vec3 n, float s) { n = normalize(n); return normalize(vec3(n.xy * s, n.z)); }
vec4 trilinear(sampler2D map, vec2 uv) {
    vec2 texels = uv * vec2(textureSize(map, 0));
    return textureLod(map, uv, log2(max(length(dFdx(texels)), length(dFdy(texels)))));
}
void main() {
    vec2 uv = gl_FragCoord.xy / extent;
    vec3 n1 = scaled(trilinear(base, uv).xyz, baseScale);
    vec3 n2 = scaled(trilinear(detail, uv * tiling + offset).xyz, detailScale);
    result = vec4(normalize(vec3(n1.xy + n2.xy, n1.z * n2.z)), 1.0);
})";

}  // namespace

std::vector<float> draw_whiteout(const GlBlend& blend) {
    if (!software_gl_works()) return {};
    const Gl& gl = software_gl();
    const GLuint program = make_program(kWholeTarget, kFragmentShader);
    const auto vector = [](float x, float y, float z) { return Rgba{x, y, z, 1.0f}; };
    gl.ActiveTexture(GL_TEXTURE0);
    const GLuint base = upload_map(*blend.base, vector);
    gl.ActiveTexture(GL_TEXTURE1);
    const GLuint detail = upload_map(*blend.detail, vector);
    const tex::Extent extent = blend.base->levels.front().extent();
    const std::vector<float> rgba = draw(program, extent, 3, [&](const UniformLocation& place) {
        gl.Uniform1i(place("base"), 0);
        gl.Uniform1i(place("detail"), 1);
        gl.Uniform2f(place("extent"), static_cast<float>(extent.width), static_cast<float>(extent.height));
        gl.Uniform2f(place("tiling"), blend.tiling_x, blend.tiling_y);
        gl.Uniform2f(place("offset"), blend.offset_x, blend.offset_y);
        gl.Uniform1f(place("baseScale"), blend.base_scale);
        gl.Uniform1f(place("detailScale"), blend.detail_scale);
    });
    gl.DeleteTextures(1, &base);
    gl.DeleteTextures(1, &detail);
    gl.DeleteProgram(program);
    return flipped(rgba, extent);
}

}  // namespace peers
