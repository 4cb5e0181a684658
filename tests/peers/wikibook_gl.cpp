// SPDX-License-Identifier: Apache-2.0

#include "wikibook_gl.h"

#include <cstdio>
#include <string>
#include <utility>

#include <GL/osmesa.h>
#include <GL/glext.h>

#include "software_gl.h"

namespace peers {
namespace {

// "Lighting of Bumpy Surfaces" (fragWithAmbient) and "Projection of Bumpy Surfaces" of the wikibook, in GLSL 3.30; the model matrix is the
// identity. Only the places of the four corners, the camera as vectors instead of a matrix, and the sRGB curve at the end are ours.
constexpr const char* kVertexShader = R"(#version 330 core
uniform vec3 eye, right, up, toward, tangent;
uniform float slope, aspect, half_width, tangent_w;
out vec3 position, tangentWorld, normalWorld, binormalWorld, viewDirInScaledSurfaceCoords;
out vec2 texCoords;
void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    position = vec3((corner.x * 2.0 - 1.0) * half_width, corner.y * 2.0 - 1.0, 0.0);
    texCoords = tangent.x > 0.0 ? corner : vec2(-corner.x, corner.y);
    tangentWorld = tangent;
    normalWorld = vec3(0.0, 0.0, 1.0);
    binormalWorld = cross(normalWorld, tangentWorld) * tangent_w;
    vec3 viewDirInObjectCoords = eye - position;
    mat3 localSurface2ScaledObject = mat3(tangentWorld, binormalWorld, normalWorld);
    viewDirInScaledSurfaceCoords = viewDirInObjectCoords * localSurface2ScaledObject;
    vec3 p = position - eye;
    gl_Position = vec4(dot(p, right) / (slope * aspect), dot(p, up) / slope, 0.0, -dot(p, toward));
})";

constexpr const char* kFragmentShader = R"(#version 330 core
uniform sampler2D bumpMap, parallaxMap;
uniform vec3 eye, light, lightColor, ambient, color, specColor;
uniform float shininess, parallax, maxTexCoordOffset, pointLight;
in vec3 position, tangentWorld, normalWorld, binormalWorld, viewDirInScaledSurfaceCoords;
in vec2 texCoords;
out vec4 fragment;
float srgb(float c) { c = clamp(c, 0.0, 1.0); return c <= 0.0031308 ? 12.92 * c : 1.055 * pow(c, 1.0 / 2.4) - 0.055; }
void main() {
    float height = parallax * (-0.5 + texture(parallaxMap, texCoords).x);
    vec2 texCoordOffsets = clamp(height * viewDirInScaledSurfaceCoords.xy / viewDirInScaledSurfaceCoords.z,
                                 -maxTexCoordOffset, +maxTexCoordOffset);
    vec4 encodedNormal = texture(bumpMap, texCoords + texCoordOffsets);
    vec3 localCoords = vec3(2.0 * encodedNormal.a - 1.0, 2.0 * encodedNormal.g - 1.0, 0.0);
    localCoords.z = sqrt(1.0 - dot(localCoords, localCoords));
    mat3 local2WorldTranspose = mat3(tangentWorld, binormalWorld, normalWorld);
    vec3 normalDirection = normalize(local2WorldTranspose * localCoords);
    vec3 viewDirection = normalize(eye - position);
    vec3 lightDirection = normalize(light);
    float attenuation = 1.0;
    if (pointLight > 0.5) {
        vec3 vertexToLightSource = light - position;
        float distance = length(vertexToLightSource);
        attenuation = 1.0 / distance;
        lightDirection = normalize(vertexToLightSource);
    }
    vec3 ambientLighting = ambient * color;
    vec3 diffuseReflection = attenuation * lightColor * color * max(0.0, dot(normalDirection, lightDirection));
    vec3 specularReflection;
    if (dot(normalDirection, lightDirection) < 0.0) {
        specularReflection = vec3(0.0, 0.0, 0.0);
    } else {
        specularReflection = attenuation * lightColor * specColor *
            pow(max(0.0, dot(reflect(-lightDirection, normalDirection), viewDirection)), shininess);
    }
    vec3 sum = ambientLighting + diffuseReflection + specularReflection;
    fragment = vec4(srgb(sum.r), srgb(sum.g), srgb(sum.b), 1.0);
})";

// The entry points that a drawing needs.
struct Gl {
#define PEERS_GL(type, name) type name = reinterpret_cast<type>(OSMesaGetProcAddress("gl" #name))
    PEERS_GL(PFNGLCREATESHADERPROC, CreateShader);
    PEERS_GL(PFNGLSHADERSOURCEPROC, ShaderSource);
    PEERS_GL(PFNGLCOMPILESHADERPROC, CompileShader);
    PEERS_GL(PFNGLCREATEPROGRAMPROC, CreateProgram);
    PEERS_GL(PFNGLATTACHSHADERPROC, AttachShader);
    PEERS_GL(PFNGLLINKPROGRAMPROC, LinkProgram);
    PEERS_GL(PFNGLGETPROGRAMIVPROC, GetProgramiv);
    PEERS_GL(PFNGLUSEPROGRAMPROC, UseProgram);
    PEERS_GL(PFNGLGETUNIFORMLOCATIONPROC, GetUniformLocation);
    PEERS_GL(PFNGLUNIFORM1IPROC, Uniform1i);
    PEERS_GL(PFNGLUNIFORM1FPROC, Uniform1f);
    PEERS_GL(PFNGLUNIFORM3FPROC, Uniform3f);
    PEERS_GL(PFNGLGENVERTEXARRAYSPROC, GenVertexArrays);
    PEERS_GL(PFNGLBINDVERTEXARRAYPROC, BindVertexArray);
    PEERS_GL(PFNGLGENFRAMEBUFFERSPROC, GenFramebuffers);
    PEERS_GL(PFNGLBINDFRAMEBUFFERPROC, BindFramebuffer);
    PEERS_GL(PFNGLFRAMEBUFFERTEXTURE2DPROC, FramebufferTexture2D);
    PEERS_GL(PFNGLACTIVETEXTUREPROC, ActiveTexture);
    PEERS_GL(PFNGLCLEARBUFFERFVPROC, ClearBufferfv);
#undef PEERS_GL
#define PEERS_GL(result, name, ...)                                                                  \
    result (*name)(__VA_ARGS__) = reinterpret_cast<result (*)(__VA_ARGS__)>(OSMesaGetProcAddress("g" \
                                                                                                 "l" #name))
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
    for (const auto& [kind, source] :
         {std::pair{GL_VERTEX_SHADER, kVertexShader}, std::pair{GL_FRAGMENT_SHADER, kFragmentShader}}) {
        const GLuint shader = gl.CreateShader(static_cast<GLenum>(kind));
        gl.ShaderSource(shader, 1, &source, nullptr);
        gl.CompileShader(shader);
        gl.AttachShader(program, shader);
    }
    gl.LinkProgram(program);
    GLint linked = 0;
    gl.GetProgramiv(program, GL_LINK_STATUS, &linked);
    return linked != 0 ? program : 0;
}

void set_filters(const Gl& gl, bool mip_mapped) {
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, mip_mapped ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
}

// Rows from the bottom, as v grows.
void upload_map(const Gl& gl, const tex::MipChain& map) {
    GLuint texture = 0;
    gl.GenTextures(1, &texture);
    gl.BindTexture(GL_TEXTURE_2D, texture);
    for (std::size_t k = 0; k < map.levels.size(); ++k) {
        const tex::NormalMap& level = map.levels[k];
        const tex::Extent extent = level.extent();
        std::vector<float> rgba;
        for (int j = extent.height - 1; j >= 0; --j) {
            for (int i = 0; i < extent.width; ++i) {
                rgba.insert(rgba.end(),
                            {1.0f, (level.y.at(i, j) + 1.0f) / 2.0f, 1.0f, (level.x.at(i, j) + 1.0f) / 2.0f});
            }
        }
        gl.TexImage2D(GL_TEXTURE_2D, static_cast<GLint>(k), GL_RGBA32F, extent.width, extent.height, 0,
                      GL_RGBA, GL_FLOAT, rgba.data());
    }
    set_filters(gl, map.levels.size() > 1);
}

void upload_height(const Gl& gl, const tex::Plane<float>& height) {
    GLuint texture = 0;
    gl.GenTextures(1, &texture);
    gl.BindTexture(GL_TEXTURE_2D, texture);
    const tex::Extent extent = height.extent();
    std::vector<float> red;
    for (int j = extent.height - 1; j >= 0; --j)
        red.insert(red.end(), height.row(j), height.row(j) + extent.width);
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_R32F, extent.width, extent.height, 0, GL_RED, GL_FLOAT, red.data());
    set_filters(gl, false);
}

void set_uniforms(const Gl& gl, GLuint program, const GlScene& s) {
    const auto place = [&](const char* name) { return gl.GetUniformLocation(program, name); };
    const std::pair<const char*, float> numbers[] = {
        {"slope", s.slope},
        {"aspect", static_cast<float>(s.picture.width) / static_cast<float>(s.picture.height)},
        {"half_width", s.half_width},
        {"tangent_w", s.tangent_w},
        {"shininess", s.shininess},
        {"parallax", s.height != nullptr ? s.parallax : 0.0f},
        {"maxTexCoordOffset", s.parallax_limit},
        {"pointLight", s.point_light ? 1.0f : 0.0f}};
    for (const auto& [name, value] : numbers) gl.Uniform1f(place(name), value);
    const std::pair<const char*, Vec3> vectors[] = {{"eye", s.eye},
                                                    {"right", s.right},
                                                    {"up", s.up},
                                                    {"toward", s.toward},
                                                    {"tangent", s.tangent},
                                                    {"light", s.light},
                                                    {"lightColor", s.light_color},
                                                    {"ambient", s.ambient},
                                                    {"color", s.diffuse},
                                                    {"specColor", s.specular}};
    for (const auto& [name, v] : vectors) gl.Uniform3f(place(name), v[0], v[1], v[2]);
    gl.Uniform1i(place("bumpMap"), 0);
    gl.Uniform1i(place("parallaxMap"), 1);
}

void make_target(const Gl& gl, tex::Extent extent) {
    GLuint target = 0, framebuffer = 0;
    gl.GenTextures(1, &target);
    gl.BindTexture(GL_TEXTURE_2D, target);
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, extent.width, extent.height, 0, GL_RGBA, GL_FLOAT, nullptr);
    gl.GenFramebuffers(1, &framebuffer);
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target, 0);
    gl.Viewport(0, 0, extent.width, extent.height);
    constexpr float kNothing[4] = {};
    gl.ClearBufferfv(GL_COLOR, 0, kNothing);
}

}  // namespace

std::vector<float> draw_wikibook_plane(const GlScene& scene) {
    if (!software_gl_works()) return {};
    const Gl gl;
    const GLuint program = make_program(gl);
    if (program == 0) return {};
    GLuint vertices = 0;
    gl.GenVertexArrays(1, &vertices);
    gl.BindVertexArray(vertices);
    make_target(gl, scene.picture);
    gl.ActiveTexture(GL_TEXTURE1);
    if (scene.height != nullptr) upload_height(gl, *scene.height);
    gl.ActiveTexture(GL_TEXTURE0);
    upload_map(gl, *scene.map);
    gl.UseProgram(program);
    set_uniforms(gl, program, scene);
    gl.DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    const std::size_t row = static_cast<std::size_t>(scene.picture.width) * 4;
    std::vector<float> bottom_up(row * static_cast<std::size_t>(scene.picture.height)), top_down;
    gl.ReadPixels(0, 0, scene.picture.width, scene.picture.height, GL_RGBA, GL_FLOAT, bottom_up.data());
    if (gl.GetError() != GL_NO_ERROR) return {};
    for (auto end = bottom_up.end(); end != bottom_up.begin(); end -= static_cast<std::ptrdiff_t>(row)) {
        top_down.insert(top_down.end(), end - static_cast<std::ptrdiff_t>(row), end);
    }
    return top_down;
}

}  // namespace peers
