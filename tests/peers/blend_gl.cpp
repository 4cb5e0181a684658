// SPDX-License-Identifier: Apache-2.0

#include "blend_gl.h"

#include <cstring>
#include <utility>

#include <GL/osmesa.h>
#include <GL/glext.h>

#include "software_gl.h"

namespace peers {
namespace {

constexpr const char* kVertexShader =
    "#version 330 core\n"
    "void main() { vec2 p = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0; gl_Position = vec4(p, 0, 1); }\n";

// BlendNormals of Unity's shader library, on maps that a shader samples at uv * _ST.xy + _ST.zw. The level is that of the OpenGL
// specification (4.6, 8.14.1), written out: llvmpipe's own has a logarithm that is off by up to 0.09.
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

struct Gl {
#define PEERS_GL(type, name) type name = reinterpret_cast<type>(OSMesaGetProcAddress("gl" #name))
    PEERS_GL(PFNGLCREATESHADERPROC, CreateShader);
    PEERS_GL(PFNGLSHADERSOURCEPROC, ShaderSource);
    PEERS_GL(PFNGLCOMPILESHADERPROC, CompileShader);
    PEERS_GL(PFNGLCREATEPROGRAMPROC, CreateProgram);
    PEERS_GL(PFNGLATTACHSHADERPROC, AttachShader);
    PEERS_GL(PFNGLLINKPROGRAMPROC, LinkProgram);
    PEERS_GL(PFNGLUSEPROGRAMPROC, UseProgram);
    PEERS_GL(PFNGLGETUNIFORMLOCATIONPROC, GetUniformLocation);
    PEERS_GL(PFNGLUNIFORM1IPROC, Uniform1i);
    PEERS_GL(PFNGLUNIFORM1FPROC, Uniform1f);
    PEERS_GL(PFNGLUNIFORM2FPROC, Uniform2f);
    PEERS_GL(PFNGLGENVERTEXARRAYSPROC, GenVertexArrays);
    PEERS_GL(PFNGLBINDVERTEXARRAYPROC, BindVertexArray);
    PEERS_GL(PFNGLGENFRAMEBUFFERSPROC, GenFramebuffers);
    PEERS_GL(PFNGLBINDFRAMEBUFFERPROC, BindFramebuffer);
    PEERS_GL(PFNGLFRAMEBUFFERTEXTURE2DPROC, FramebufferTexture2D);
    PEERS_GL(PFNGLACTIVETEXTUREPROC, ActiveTexture);
#undef PEERS_GL
#define PEERS_GL(result, name, ...) \
    result (*name)(__VA_ARGS__) = reinterpret_cast<result (*)(__VA_ARGS__)>(OSMesaGetProcAddress("gl" #name))
    PEERS_GL(void, GenTextures, GLsizei, GLuint*);
    PEERS_GL(void, BindTexture, GLenum, GLuint);
    PEERS_GL(void, TexParameteri, GLenum, GLenum, GLint);
    PEERS_GL(void, TexImage2D, GLenum, GLint, GLint, GLsizei, GLsizei, GLint, GLenum, GLenum, const void*);
    PEERS_GL(void, Viewport, GLint, GLint, GLsizei, GLsizei);
    PEERS_GL(void, DrawArrays, GLenum, GLint, GLsizei);
    PEERS_GL(void, ReadPixels, GLint, GLint, GLsizei, GLsizei, GLenum, GLenum, void*);
    PEERS_GL(GLenum, GetError, void);
#undef PEERS_GL
};

GLuint make_program(const Gl& gl) {
    const GLuint program = gl.CreateProgram();
    for (const auto& [kind, source] : {std::pair{GL_VERTEX_SHADER, kVertexShader}, std::pair{GL_FRAGMENT_SHADER, kFragmentShader}}) {
        const GLuint shader = gl.CreateShader(static_cast<GLenum>(kind));
        gl.ShaderSource(shader, 1, &source, nullptr);
        gl.CompileShader(shader);
        gl.AttachShader(program, shader);
    }
    gl.LinkProgram(program);
    return program;
}

// Rows from the bottom, as v grows.
void upload(const Gl& gl, GLenum unit, const tex::MipChain& map) {
    GLuint texture = 0;
    gl.ActiveTexture(unit);
    gl.GenTextures(1, &texture);
    gl.BindTexture(GL_TEXTURE_2D, texture);
    for (std::size_t k = 0; k < map.levels.size(); ++k) {
        const tex::NormalMap& level = map.levels[k];
        const tex::Extent extent = level.extent();
        std::vector<float> rgba;
        for (int j = extent.height - 1; j >= 0; --j) {
            for (int i = 0; i < extent.width; ++i) {
                rgba.insert(rgba.end(), {level.x.at(i, j), level.y.at(i, j), level.z.at(i, j), 1.0f});
            }
        }
        gl.TexImage2D(GL_TEXTURE_2D, static_cast<GLint>(k), GL_RGBA32F, extent.width, extent.height, 0, GL_RGBA, GL_FLOAT, rgba.data());
    }
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, static_cast<GLint>(map.levels.size() - 1));
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
}

void make_target(const Gl& gl, tex::Extent extent) {
    GLuint target = 0, framebuffer = 0;
    gl.ActiveTexture(GL_TEXTURE2);
    gl.GenTextures(1, &target);
    gl.BindTexture(GL_TEXTURE_2D, target);
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, extent.width, extent.height, 0, GL_RGBA, GL_FLOAT, nullptr);
    gl.GenFramebuffers(1, &framebuffer);
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target, 0);
    gl.Viewport(0, 0, extent.width, extent.height);
}

}  // namespace

std::vector<float> draw_whiteout(const GlBlend& blend) {
    if (!software_gl_works()) return {};
    const Gl gl;
    const GLuint program = make_program(gl);
    GLuint vertices = 0;
    gl.GenVertexArrays(1, &vertices);
    gl.BindVertexArray(vertices);
    const tex::Extent extent = blend.base->levels.front().extent();
    make_target(gl, extent);
    upload(gl, GL_TEXTURE0, *blend.base);
    upload(gl, GL_TEXTURE1, *blend.detail);
    gl.UseProgram(program);
    const auto place = [&](const char* name) { return gl.GetUniformLocation(program, name); };
    gl.Uniform1i(place("base"), 0);
    gl.Uniform1i(place("detail"), 1);
    gl.Uniform2f(place("extent"), static_cast<float>(extent.width), static_cast<float>(extent.height));
    gl.Uniform2f(place("tiling"), blend.tiling_x, blend.tiling_y);
    gl.Uniform2f(place("offset"), blend.offset_x, blend.offset_y);
    gl.Uniform1f(place("baseScale"), blend.base_scale);
    gl.Uniform1f(place("detailScale"), blend.detail_scale);
    gl.DrawArrays(GL_TRIANGLE_STRIP, 0, 3);

    const std::size_t pitch = static_cast<std::size_t>(extent.width) * 4;
    std::vector<float> upwards(pitch * static_cast<std::size_t>(extent.height));
    gl.ReadPixels(0, 0, extent.width, extent.height, GL_RGBA, GL_FLOAT, upwards.data());
    gl.ActiveTexture(GL_TEXTURE0);
    if (gl.GetError() != GL_NO_ERROR) return {};
    std::vector<float> rows(upwards.size());
    for (std::size_t j = 0; j < static_cast<std::size_t>(extent.height); ++j) {
        std::memcpy(&rows[j * pitch], &upwards[(static_cast<std::size_t>(extent.height) - 1 - j) * pitch], pitch * sizeof(float));
    }
    return rows;
}

}  // namespace peers
