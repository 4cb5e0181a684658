// SPDX-License-Identifier: Apache-2.0

#include "software_gl.h"

#include <array>
#include <cstdlib>

#include <GL/osmesa.h>
#include <GL/glext.h>

namespace peers {
namespace {

template <class Function>
Function load(const char* name) {
    return reinterpret_cast<Function>(OSMesaGetProcAddress(name));
}

// The entry points that sampling needs; Mesa's off-screen library exports none of them by itself.
struct Gl {
#define PEERS_GL(type, name) type name = load<type>("gl" #name)
    PEERS_GL(PFNGLCREATESHADERPROC, CreateShader);
    PEERS_GL(PFNGLSHADERSOURCEPROC, ShaderSource);
    PEERS_GL(PFNGLCOMPILESHADERPROC, CompileShader);
    PEERS_GL(PFNGLCREATEPROGRAMPROC, CreateProgram);
    PEERS_GL(PFNGLATTACHSHADERPROC, AttachShader);
    PEERS_GL(PFNGLLINKPROGRAMPROC, LinkProgram);
    PEERS_GL(PFNGLUSEPROGRAMPROC, UseProgram);
    PEERS_GL(PFNGLGETUNIFORMLOCATIONPROC, GetUniformLocation);
    PEERS_GL(PFNGLUNIFORM1FPROC, Uniform1f);
    PEERS_GL(PFNGLUNIFORM2FPROC, Uniform2f);
    PEERS_GL(PFNGLGENVERTEXARRAYSPROC, GenVertexArrays);
    PEERS_GL(PFNGLBINDVERTEXARRAYPROC, BindVertexArray);
    PEERS_GL(PFNGLGENFRAMEBUFFERSPROC, GenFramebuffers);
    PEERS_GL(PFNGLDELETEFRAMEBUFFERSPROC, DeleteFramebuffers);
    PEERS_GL(PFNGLBINDFRAMEBUFFERPROC, BindFramebuffer);
    PEERS_GL(PFNGLFRAMEBUFFERTEXTURE2DPROC, FramebufferTexture2D);
    PEERS_GL(PFNGLCOMPRESSEDTEXIMAGE2DPROC, CompressedTexImage2D);
#undef PEERS_GL
#define PEERS_GL(result, name, ...) \
    result (*name)(__VA_ARGS__) = load<result (*)(__VA_ARGS__)>("gl" #name)
    PEERS_GL(void, GenTextures, GLsizei, GLuint*);
    PEERS_GL(void, DeleteTextures, GLsizei, const GLuint*);
    PEERS_GL(void, BindTexture, GLenum, GLuint);
    PEERS_GL(void, TexParameteri, GLenum, GLenum, GLint);
    PEERS_GL(void, TexImage2D, GLenum, GLint, GLint, GLsizei, GLsizei, GLint, GLenum, GLenum, const void*);
    PEERS_GL(void, Viewport, GLint, GLint, GLsizei, GLsizei);
    PEERS_GL(void, DrawArrays, GLenum, GLint, GLsizei);
    PEERS_GL(void, ReadPixels, GLint, GLint, GLsizei, GLsizei, GLenum, GLenum, void*);
    PEERS_GL(GLenum, GetError, void);
#undef PEERS_GL
};

constexpr const char* kVertexShader =
    "#version 330 core\n"
    "void main() { vec2 p = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0; gl_Position = vec4(p, 0, 1); }\n";
constexpr const char* kFragmentShader =
    "#version 330 core\n"
    "uniform sampler2D map; uniform float lod; uniform vec2 extent; out vec4 color;\n"
    "void main() { color = textureLod(map, gl_FragCoord.xy / extent, lod); }\n";

bool make_context() {
    // Shortcuts in llvmpipe: 8-bit ones would round what the shader reads, others mix less of the next mip level than they should.
    setenv("GALLIVM_PERF", "no_aos_sampling,no_brilinear,no_rho_approx,no_quad_lod", 1);
    const int attributes[] = {OSMESA_FORMAT, OSMESA_RGBA, OSMESA_PROFILE, OSMESA_CORE_PROFILE,
                              OSMESA_CONTEXT_MAJOR_VERSION, 3, OSMESA_CONTEXT_MINOR_VERSION, 3, 0};
    static std::array<unsigned char, 4 * 16 * 16> buffer;
    OSMesaContext context = OSMesaCreateContextAttribs(attributes, nullptr);
    return context != nullptr && OSMesaMakeCurrent(context, buffer.data(), GL_UNSIGNED_BYTE, 16, 16) == GL_TRUE;
}

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

GLenum gl_format(tex::Format format) {
    switch (format) {
        case tex::Format::bc3_unorm: return GL_COMPRESSED_RGBA_S3TC_DXT5_EXT;
        case tex::Format::bc5_unorm: return GL_COMPRESSED_RG_RGTC2;
        case tex::Format::bc5_snorm: return GL_COMPRESSED_SIGNED_RG_RGTC2;
        default: return 0;
    }
}

GLuint upload(const Gl& gl, tex::Format format, const std::vector<GlLevel>& levels) {
    GLuint texture = 0;
    gl.GenTextures(1, &texture);
    gl.BindTexture(GL_TEXTURE_2D, texture);
    for (std::size_t k = 0; k < levels.size(); ++k) {
        gl.CompressedTexImage2D(GL_TEXTURE_2D, static_cast<GLint>(k), gl_format(format), levels[k].extent.width,
                                levels[k].extent.height, 0, static_cast<GLsizei>(levels[k].bytes.size()),
                                levels[k].bytes.data());
    }
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return texture;
}

GlTexels draw_level(const Gl& gl, GLuint program, GLuint texture, int level, tex::Extent extent) {
    GLuint target = 0;
    gl.GenTextures(1, &target);
    gl.BindTexture(GL_TEXTURE_2D, target);
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, extent.width, extent.height, 0, GL_RGBA, GL_FLOAT, nullptr);
    GLuint framebuffer = 0;
    gl.GenFramebuffers(1, &framebuffer);
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target, 0);
    gl.Viewport(0, 0, extent.width, extent.height);
    gl.BindTexture(GL_TEXTURE_2D, texture);
    gl.UseProgram(program);
    gl.Uniform1f(gl.GetUniformLocation(program, "lod"), static_cast<float>(level));
    gl.Uniform2f(gl.GetUniformLocation(program, "extent"), static_cast<float>(extent.width),
                 static_cast<float>(extent.height));
    gl.DrawArrays(GL_TRIANGLE_STRIP, 0, 3);
    GlTexels texels{extent, std::vector<float>(static_cast<std::size_t>(extent.texels()) * 4)};
    gl.ReadPixels(0, 0, extent.width, extent.height, GL_RGBA, GL_FLOAT, texels.rgba.data());
    gl.DeleteFramebuffers(1, &framebuffer);
    gl.DeleteTextures(1, &target);
    return texels;
}

}  // namespace

bool software_gl_works() {
    static const bool works = make_context();
    return works;
}

std::vector<GlTexels> sample_levels(tex::Format format, const std::vector<GlLevel>& levels) {
    if (!software_gl_works()) return {};
    static const Gl gl;
    static const GLuint program = make_program(gl);
    static const GLuint vertices = [] {
        GLuint name = 0;
        gl.GenVertexArrays(1, &name);
        return name;
    }();
    gl.BindVertexArray(vertices);
    const GLuint texture = upload(gl, format, levels);
    std::vector<GlTexels> result;
    for (std::size_t k = 0; k < levels.size(); ++k) {
        result.push_back(draw_level(gl, program, texture, static_cast<int>(k), levels[k].extent));
    }
    gl.DeleteTextures(1, &texture);
    if (gl.GetError() != GL_NO_ERROR) result.clear();
    return result;
}

}  // namespace peers
