// SPDX-License-Identifier: Apache-2.0

#include "software_gl.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

namespace peers {
namespace {

bool make_context() {
    // Shortcuts in llvmpipe: 8-bit ones would round what the shader reads, others mix less of the next mip level than
    // they should.
    setenv("GALLIVM_PERF", "no_aos_sampling,no_brilinear,no_rho_approx,no_quad_lod", 1);
    const int attributes[] = {OSMESA_FORMAT,
                              OSMESA_RGBA,
                              OSMESA_PROFILE,
                              OSMESA_CORE_PROFILE,
                              OSMESA_CONTEXT_MAJOR_VERSION,
                              3,
                              OSMESA_CONTEXT_MINOR_VERSION,
                              3,
                              0};
    static std::array<unsigned char, 4 * 16 * 16> buffer;
    OSMesaContext context = OSMesaCreateContextAttribs(attributes, nullptr);
    return context != nullptr && OSMesaMakeCurrent(context, buffer.data(), GL_UNSIGNED_BYTE, 16, 16) == GL_TRUE;
}

GLuint bind_new_texture() {
    GLuint texture = 0;
    software_gl().GenTextures(1, &texture);
    software_gl().BindTexture(GL_TEXTURE_2D, texture);
    return texture;
}

void set_filters(std::size_t levels) {
    const Gl& gl = software_gl();
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, static_cast<GLint>(levels - 1));
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, levels > 1 ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
}

}  // namespace

const char* const kWholeTarget =
    "#version 330 core\n"
    "void main() { vec2 p = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0; gl_Position = vec4(p, 0, 1); }\n";

bool software_gl_works() {
    static const bool works = make_context();
    return works;
}

bool software_gl_has(std::string_view extension) {
    GLint count = 0;
    software_gl().GetIntegerv(GL_NUM_EXTENSIONS, &count);
    for (GLuint k = 0; k < static_cast<GLuint>(count); ++k) {
        if (extension == reinterpret_cast<const char*>(software_gl().GetStringi(GL_EXTENSIONS, k))) return true;
    }
    return false;
}

const Gl& software_gl() {
    static const Gl gl = [] {
        Gl entries;
        GLuint vertices = 0;
        entries.GenVertexArrays(1, &vertices);
        entries.BindVertexArray(vertices);
        return entries;
    }();
    return gl;
}

GLuint make_program(const char* vertex_shader, const char* fragment_shader) {
    const Gl& gl = software_gl();
    const GLuint program = gl.CreateProgram();
    for (const auto& [kind, source] :
         {std::pair{GL_VERTEX_SHADER, vertex_shader}, std::pair{GL_FRAGMENT_SHADER, fragment_shader}}) {
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

GLuint upload_map(const tex::MipChain& map, const std::function<Rgba(float, float, float)>& texel) {
    const GLuint texture = bind_new_texture();
    for (std::size_t k = 0; k < map.levels.size(); ++k) {
        const tex::NormalMap& level = map.levels[k];
        const tex::Extent extent = level.extent();
        std::vector<float> rgba;
        for (int j = extent.height - 1; j >= 0; --j) {
            for (int i = 0; i < extent.width; ++i) {
                const Rgba values = texel(level.x.at(i, j), level.y.at(i, j), level.z.at(i, j));
                rgba.insert(rgba.end(), values.begin(), values.end());
            }
        }
        software_gl().TexImage2D(GL_TEXTURE_2D, static_cast<GLint>(k), GL_RGBA32F, extent.width, extent.height, 0,
                                 GL_RGBA, GL_FLOAT, rgba.data());
    }
    set_filters(map.levels.size());
    return texture;
}

GLuint upload_plane(const tex::Plane<float>& plane) {
    const GLuint texture = bind_new_texture();
    const tex::Extent extent = plane.extent();
    std::vector<float> red;
    for (int j = extent.height - 1; j >= 0; --j) red.insert(red.end(), plane.row(j), plane.row(j) + extent.width);
    software_gl().TexImage2D(GL_TEXTURE_2D, 0, GL_R32F, extent.width, extent.height, 0, GL_RED, GL_FLOAT, red.data());
    set_filters(1);
    return texture;
}

namespace {

// Draws with the shape of vertices `mode`, and a depth buffer if there are triangles.
std::vector<float> draw_as(GLenum mode, GLuint program, tex::Extent extent, int vertices,
                           const std::function<void(const UniformLocation&)>& set_uniforms) {
    const Gl& gl = software_gl();
    const bool with_depth = mode == GL_TRIANGLES;
    gl.ActiveTexture(GL_TEXTURE2);  // 0 and 1 hold the maps
    const GLuint target = bind_new_texture();
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, extent.width, extent.height, 0, GL_RGBA, GL_FLOAT, nullptr);
    GLuint framebuffer = 0, depth = 0;
    gl.GenFramebuffers(1, &framebuffer);
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target, 0);
    constexpr GLenum kTests[] = {GL_DEPTH_TEST, GL_CULL_FACE};
    if (with_depth) {
        depth = bind_new_texture();
        gl.TexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, extent.width, extent.height, 0, GL_DEPTH_COMPONENT,
                      GL_FLOAT, nullptr);
        gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
        constexpr float kFar = 1.0f;
        gl.ClearBufferfv(GL_DEPTH, 0, &kFar);
        for (const GLenum test : kTests) gl.Enable(test);
    }
    gl.Viewport(0, 0, extent.width, extent.height);
    constexpr float kNothing[4] = {};
    gl.ClearBufferfv(GL_COLOR, 0, kNothing);
    gl.UseProgram(program);
    set_uniforms([&](const char* uniform) { return gl.GetUniformLocation(program, uniform); });
    gl.DrawArrays(mode, 0, vertices);
    std::vector<float> rgba(static_cast<std::size_t>(extent.texels()) * 4);
    gl.ReadPixels(0, 0, extent.width, extent.height, GL_RGBA, GL_FLOAT, rgba.data());
    for (const GLenum test : kTests) gl.Disable(test);
    gl.DeleteFramebuffers(1, &framebuffer);
    gl.DeleteTextures(1, &target);
    if (with_depth) gl.DeleteTextures(1, &depth);
    gl.ActiveTexture(GL_TEXTURE0);
    if (gl.GetError() != GL_NO_ERROR) rgba.clear();
    return rgba;
}

}  // namespace

std::vector<float> draw(GLuint program, tex::Extent extent, int vertices,
                        const std::function<void(const UniformLocation&)>& set_uniforms) {
    return draw_as(GL_TRIANGLE_STRIP, program, extent, vertices, set_uniforms);
}

std::vector<float> draw_triangles(GLuint program, tex::Extent extent, int vertices,
                                  const std::function<void(const UniformLocation&)>& set_uniforms) {
    return draw_as(GL_TRIANGLES, program, extent, vertices, set_uniforms);
}

std::vector<float> flipped(const std::vector<float>& rgba, tex::Extent extent) {
    std::vector<float> rows(rgba.size());
    const auto pitch = static_cast<std::ptrdiff_t>(extent.width) * 4;
    auto to = rows.begin();
    for (auto end = rgba.end(); end != rgba.begin(); end -= pitch) to = std::copy(end - pitch, end, to);
    return rows;
}

}  // namespace peers
