// SPDX-License-Identifier: Apache-2.0
// software_gl.h: an OpenGL driver that nobody here wrote (Mesa's llvmpipe, off screen), and what every drawing with it
// needs.

#pragma once

#include <array>
#include <functional>
#include <string_view>
#include <vector>

#include <GL/osmesa.h>
// After osmesa.h, which has the types of glext.h's declarations.
#include <GL/glext.h>

#include <tex/format.h>
#include <tex/types.h>

namespace peers {

// The entry points; Mesa's off-screen library exports none of them by itself.
struct Gl {
    template <class Function>
    static Function load(const char* name) {
        return reinterpret_cast<Function>(OSMesaGetProcAddress(name));
    }
#define PEERS_GL(type, name) type name = load<type>("gl" #name)
    PEERS_GL(PFNGLCREATESHADERPROC, CreateShader);
    PEERS_GL(PFNGLSHADERSOURCEPROC, ShaderSource);
    PEERS_GL(PFNGLCOMPILESHADERPROC, CompileShader);
    PEERS_GL(PFNGLCREATEPROGRAMPROC, CreateProgram);
    PEERS_GL(PFNGLATTACHSHADERPROC, AttachShader);
    PEERS_GL(PFNGLLINKPROGRAMPROC, LinkProgram);
    PEERS_GL(PFNGLGETPROGRAMIVPROC, GetProgramiv);
    PEERS_GL(PFNGLUSEPROGRAMPROC, UseProgram);
    PEERS_GL(PFNGLDELETEPROGRAMPROC, DeleteProgram);
    PEERS_GL(PFNGLGETUNIFORMLOCATIONPROC, GetUniformLocation);
    PEERS_GL(PFNGLUNIFORM1IPROC, Uniform1i);
    PEERS_GL(PFNGLUNIFORM1FPROC, Uniform1f);
    PEERS_GL(PFNGLUNIFORM2FPROC, Uniform2f);
    PEERS_GL(PFNGLUNIFORM3FPROC, Uniform3f);
    PEERS_GL(PFNGLGENVERTEXARRAYSPROC, GenVertexArrays);
    PEERS_GL(PFNGLBINDVERTEXARRAYPROC, BindVertexArray);
    PEERS_GL(PFNGLGENFRAMEBUFFERSPROC, GenFramebuffers);
    PEERS_GL(PFNGLDELETEFRAMEBUFFERSPROC, DeleteFramebuffers);
    PEERS_GL(PFNGLBINDFRAMEBUFFERPROC, BindFramebuffer);
    PEERS_GL(PFNGLFRAMEBUFFERTEXTURE2DPROC, FramebufferTexture2D);
    PEERS_GL(PFNGLACTIVETEXTUREPROC, ActiveTexture);
    PEERS_GL(PFNGLCOMPRESSEDTEXIMAGE2DPROC, CompressedTexImage2D);
    PEERS_GL(PFNGLTEXIMAGE3DPROC, TexImage3D);
    PEERS_GL(PFNGLCLEARBUFFERFVPROC, ClearBufferfv);
    PEERS_GL(PFNGLGETSTRINGIPROC, GetStringi);
#undef PEERS_GL
#define PEERS_GL(result, name, ...) result (*name)(__VA_ARGS__) = load<result (*)(__VA_ARGS__)>("gl" #name)
    PEERS_GL(void, GenTextures, GLsizei, GLuint*);
    PEERS_GL(void, DeleteTextures, GLsizei, const GLuint*);
    PEERS_GL(void, BindTexture, GLenum, GLuint);
    PEERS_GL(void, TexParameteri, GLenum, GLenum, GLint);
    PEERS_GL(void, TexImage2D, GLenum, GLint, GLint, GLsizei, GLsizei, GLint, GLenum, GLenum, const void*);
    PEERS_GL(void, Viewport, GLint, GLint, GLsizei, GLsizei);
    PEERS_GL(void, DrawArrays, GLenum, GLint, GLsizei);
    PEERS_GL(void, Enable, GLenum);
    PEERS_GL(void, Disable, GLenum);
    PEERS_GL(void, ReadPixels, GLint, GLint, GLsizei, GLsizei, GLenum, GLenum, void*);
    PEERS_GL(GLenum, GetError, void);
    PEERS_GL(void, GetIntegerv, GLenum, GLint*);
#undef PEERS_GL
};

// True where Mesa gave a context (once for the process).
bool software_gl_works();

// Whether Mesa has an extension. Only where software_gl_works().
bool software_gl_has(std::string_view extension);

// The entry points, with an empty vertex array bound: vertices come from gl_VertexID. Only where software_gl_works().
const Gl& software_gl();

// A vertex shader for draw(): one triangle over the whole target.
extern const char* const kWholeTarget;

// 0 where the shaders do not compile or link.
GLuint make_program(const char* vertex_shader, const char* fragment_shader);

// A texture of floats, bound to the active unit, its rows from the bottom, as v grows; repeated, sampled with linear
// filters, also between levels where there are several. `texel` gives the RGBA of a normal.
using Rgba = std::array<float, 4>;
GLuint upload_map(const tex::MipChain& map, const std::function<Rgba(float x, float y, float z)>& texel);

// Draws one plane, in the red channel.
GLuint upload_plane(const tex::Plane<float>& plane);

// Draws `vertices` of a triangle strip with the program, whose uniforms set_uniforms(place) sets, over a cleared
// RGBA32F target. Returns RGBA of each texel, rows from the bottom of the target; empty where OpenGL reported an error
// since the last drawing. Textures stay bound.
using UniformLocation = std::function<GLint(const char* uniform)>;
std::vector<float> draw(GLuint program, tex::Extent target, int vertices,
                        const std::function<void(const UniformLocation&)>& set_uniforms);

// Draws separate triangles: nearer ones hide others, and those whose corners are clockwise are not drawn.
std::vector<float> draw_triangles(GLuint program, tex::Extent target, int vertices,
                                  const std::function<void(const UniformLocation&)>& set_uniforms);

// Rows of RGBA, the last first.
std::vector<float> flipped(const std::vector<float>& rgba, tex::Extent extent);

}  // namespace peers
