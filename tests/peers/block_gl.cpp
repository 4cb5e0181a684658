// SPDX-License-Identifier: Apache-2.0

#include "block_gl.h"

#include <utility>

#include "software_gl.h"

namespace peers {
namespace {

constexpr const char* kBlockFragmentShader =
    "#version 330 core\n"
    "uniform sampler2D map; uniform float lod; uniform vec2 extent; out vec4 color;\n"
    "void main() { color = textureLod(map, gl_FragCoord.xy / extent, lod); }\n";

GLenum gl_format(tex::Format format) {
    switch (format) {
        case tex::Format::bc3_unorm: return GL_COMPRESSED_RGBA_S3TC_DXT5_EXT;
        case tex::Format::bc5_unorm: return GL_COMPRESSED_RG_RGTC2;
        case tex::Format::bc5_snorm: return GL_COMPRESSED_SIGNED_RG_RGTC2;
        case tex::Format::bc6h_ufloat: return GL_COMPRESSED_RGB_BPTC_UNSIGNED_FLOAT;
        case tex::Format::bc6h_sfloat: return GL_COMPRESSED_RGB_BPTC_SIGNED_FLOAT;
        case tex::Format::bc7_unorm: return GL_COMPRESSED_RGBA_BPTC_UNORM;
        case tex::Format::eac_r11_unorm: return GL_COMPRESSED_R11_EAC;
        case tex::Format::eac_r11_snorm: return GL_COMPRESSED_SIGNED_R11_EAC;
        case tex::Format::eac_rg11_unorm: return GL_COMPRESSED_RG11_EAC;
        case tex::Format::eac_rg11_snorm: return GL_COMPRESSED_SIGNED_RG11_EAC;
        case tex::Format::astc_4x4_unorm: return GL_COMPRESSED_RGBA_ASTC_4x4_KHR;
        case tex::Format::astc_6x5_unorm: return GL_COMPRESSED_RGBA_ASTC_6x5_KHR;
        case tex::Format::astc_8x8_unorm: return GL_COMPRESSED_RGBA_ASTC_8x8_KHR;
        default: return 0;
    }
}

GLuint upload_blocks(const Gl& gl, tex::Format format, const std::vector<tex::Level>& levels) {
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

}  // namespace

std::vector<std::vector<float>> sample_levels(tex::Format format, const std::vector<tex::Level>& levels) {
    if (!software_gl_works()) return {};
    const Gl& gl = software_gl();
    static const GLuint program = make_program(kWholeTarget, kBlockFragmentShader);
    const GLuint texture = upload_blocks(gl, format, levels);
    std::vector<std::vector<float>> result;
    for (std::size_t k = 0; k < levels.size(); ++k) {
        const tex::Extent extent = levels[k].extent;
        std::vector<float> rgba = draw(program, extent, 3, [&](const UniformLocation& place) {
            gl.Uniform1f(place("lod"), static_cast<float>(k));
            gl.Uniform2f(place("extent"), static_cast<float>(extent.width), static_cast<float>(extent.height));
        });
        if (rgba.empty()) return {};
        result.push_back(std::move(rgba));
    }
    gl.DeleteTextures(1, &texture);
    return result;
}

}  // namespace peers
