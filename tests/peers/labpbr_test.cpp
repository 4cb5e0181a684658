// SPDX-License-Identifier: Apache-2.0
// The shader of normal-maps(7) for LabPBR, run by Mesa on the texture that is made of heights, beside their slopes and
// a brute force of what they hide.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tex/bake.h>
#include <tex/pack.h>
#include <tex/surface.h>

#include "reference/occlusion.h"
#include "software_gl.h"
#include "unit/fields.h"

namespace {

std::string labpbr_shader_of_manual() {
    std::ifstream file(TEX_SOURCE_DIR "/man/shared/labpbr-shader.mdoc");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const std::size_t begin = text.find("float lit"), end = text.find(".Ed");
    return begin == std::string::npos || end == std::string::npos ? std::string() : text.substr(begin, end - begin);
}

// x and y, green down, occlusion in blue, heights in alpha: what --layout labpbr makes.
tex::Texture labpbr_of(const tex::HeightField& field) {
    auto map = tex::bake(field);
    auto hidden = tex::occlusion(field, {32, 0.0f, true, false, false});
    EXPECT_TRUE(map && hidden);
    map->blue = std::move(hidden->occlusion);
    tex::MipChain chain;
    chain.levels.push_back(std::move(*map));
    auto texture = tex::pack(chain, {tex::Encoding::rgba8, tex::YAxis::down});
    EXPECT_TRUE(texture);
    return std::move(*texture);
}

TEST(MesaLabPbr, TheManualsShaderLightsATextureMadeOfHeights) {
    ASSERT_TRUE(peers::software_gl_works());
    const peers::Gl& gl = peers::software_gl();
    const tex::Extent extent{48, 40};
    const tex::HeightField field = tex::fields::field_of(extent, 5.0f, tex::Wrap::repeat, [&](int i, int j) {
        const double x = 6.2831853 * i / extent.width, y = 6.2831853 * j / extent.height;
        return std::sin(x + 2.0 * y) + std::cos(2.0 * x) + 0.4 * std::sin(3.0 * y - x);
    });
    const tex::Texture made = labpbr_of(field);
    const auto normals = tex::bake(field);
    ASSERT_TRUE(normals);
    const std::string shader =
        "#version 330 core\nuniform sampler2D normals;\nuniform vec2 extent;\nuniform vec3 light;\nout vec4 result;\n" +
        labpbr_shader_of_manual() +
        "void main() { result = vec4(lit(normals, gl_FragCoord.xy / extent, light, 0.5)); }";
    const GLuint program = peers::make_program(peers::kWholeTarget, shader.c_str());
    ASSERT_NE(program, 0u) << shader;
    GLuint texture = 0;
    gl.ActiveTexture(GL_TEXTURE0);
    gl.GenTextures(1, &texture);
    gl.BindTexture(GL_TEXTURE_2D, texture);
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, extent.width, extent.height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                  made.levels.front().bytes.data());
    constexpr GLenum kFilters[] = {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER};
    for (const GLenum filter : kFilters) gl.TexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
    const double light[] = {0.48, 0.6, 0.64};  // from above and from the right
    const std::vector<float> shaded = peers::draw(program, extent, 3, [&](const peers::UniformLocation& place) {
        gl.Uniform1i(place("normals"), 0);
        gl.Uniform2f(place("extent"), static_cast<float>(extent.width), static_cast<float>(extent.height));
        gl.Uniform3f(place("light"), static_cast<float>(light[0]), static_cast<float>(light[1]),
                     static_cast<float>(light[2]));
    });
    ASSERT_FALSE(shaded.empty());
    for (int j = 0; j < extent.height; j += 3) {
        for (int i = 0; i < extent.width; i += 3) {
            const double x = static_cast<double>(normals->x.at(i, j)), y = static_cast<double>(normals->y.at(i, j));
            const double z = static_cast<double>(normals->z.at(i, j));
            const double open = tex::reference::sky_of(field, i, j, -x / z, -y / z, 64).occlusion;
            const double expected = std::max(x * light[0] + y * light[1] + z * light[2], 0.0) + 0.5 * open;
            // The first row of the texture is that of the picture's top, and of the target's bottom.
            const double seen = static_cast<double>(shaded[static_cast<std::size_t>(4 * (j * extent.width + i))]);
            ASSERT_NEAR(seen, expected, 0.03) << i << " " << j;
        }
    }
    gl.DeleteTextures(1, &texture);
    gl.DeleteProgram(program);
}

}  // namespace
