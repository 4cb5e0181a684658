// SPDX-License-Identifier: Apache-2.0
// The shader of normal-maps(7) for shadows that heights cast on themselves, run by Mesa on the horizons of a field,
// beside brute force.

#include <cmath>
#include <cstddef>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/surface.h>

#include "reference/occlusion.h"
#include "software_gl.h"
#include "unit/fields.h"

namespace {

constexpr int kSlices = 8;

// The lines of the manual's example.
std::string shader_of_manual() {
    std::ifstream file(TEX_SOURCE_DIR "/man/shared/horizons-shader.mdoc");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const std::size_t begin = text.find("float sunlit"), end = text.find(".Ed");
    return begin == std::string::npos || end == std::string::npos ? std::string() : text.substr(begin, end - begin);
}

// The horizons as slices of a 3D texture, which repeats; rows from the bottom, as v grows.
GLuint upload_horizons(const std::vector<tex::Plane<float>>& horizons) {
    const peers::Gl& gl = peers::software_gl();
    const tex::Extent extent = horizons.front().extent();
    std::vector<float> sines;
    for (const tex::Plane<float>& plane : horizons) {
        for (int j = extent.height - 1; j >= 0; --j)
            sines.insert(sines.end(), plane.row(j), plane.row(j) + extent.width);
    }
    GLuint texture = 0;
    gl.ActiveTexture(GL_TEXTURE0);
    gl.GenTextures(1, &texture);
    gl.BindTexture(GL_TEXTURE_3D, texture);
    gl.TexImage3D(GL_TEXTURE_3D, 0, GL_R32F, extent.width, extent.height, kSlices, 0, GL_RED, GL_FLOAT, sines.data());
    constexpr GLenum kFilters[] = {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER};
    for (const GLenum filter : kFilters) gl.TexParameteri(GL_TEXTURE_3D, filter, GL_LINEAR);
    constexpr GLenum kAxes[] = {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R};
    for (const GLenum axis : kAxes) gl.TexParameteri(GL_TEXTURE_3D, axis, GL_REPEAT);
    return texture;
}

struct Sun {
    double turn, sine;
};

// The part of texels on which the shader and a ray agree, apart from those near the edge of a shadow.
double agreement(const tex::HeightField& field, const std::vector<float>& shaded, Sun sun) {
    const tex::Extent extent = field.height.extent();
    const double angle = 2.0 * 3.14159265358979323846 * sun.turn;
    int agree = 0, count = 0;
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const double horizon =
                std::sin(std::atan(tex::reference::horizon_of(field, i, j, std::cos(angle), std::sin(angle))));
            if (std::abs(horizon - sun.sine) < 0.05) continue;
            const auto texel = static_cast<std::size_t>(4 * (j * extent.width + i));
            agree += (shaded[texel] > 0.5f) == (sun.sine > horizon) ? 1 : 0;
            ++count;
        }
    }
    EXPECT_GT(count, extent.texels() / 2);
    return static_cast<double>(agree) / count;
}

TEST(MesaHorizons, TheManualsShaderCastsTheShadowsOfRays) {
    ASSERT_TRUE(peers::software_gl_works());
    const peers::Gl& gl = peers::software_gl();
    const tex::Extent extent{48, 40};
    const tex::HeightField field = tex::fields::field_of(extent, 5.0f, tex::Wrap::repeat, [&](int i, int j) {
        const double x = 6.2831853 * i / extent.width, y = 6.2831853 * j / extent.height;
        return std::sin(x + 2.0 * y) + std::cos(2.0 * x) + 0.4 * std::sin(3.0 * y - x);
    });
    const auto maps = tex::occlusion(field, {4, 0.0f, false, false, false, kSlices});
    ASSERT_TRUE(maps);
    const std::string shader =
        "#version 330 core\nuniform sampler3D horizons;\nuniform vec2 extent;\n"
        "uniform vec3 light;\nout vec4 result;\n" +
        shader_of_manual() + "void main() { result = vec4(sunlit(horizons, gl_FragCoord.xy / extent, light)); }";
    const GLuint program = peers::make_program(peers::kWholeTarget, shader.c_str());
    ASSERT_NE(program, 0u) << shader;
    const GLuint texture = upload_horizons(maps->horizons);
    const Sun suns[] = {{0.0, 0.3}, {0.25, 0.45}, {0.375, 0.4}, {0.875, 0.2}, {0.1, 0.4}, {0.69, 0.3}};
    for (const Sun& sun : suns) {
        const double level = std::sqrt(1.0 - sun.sine * sun.sine), angle = 2.0 * 3.14159265358979323846 * sun.turn;
        const std::vector<float> shaded = peers::draw(program, extent, 3, [&](const peers::UniformLocation& place) {
            gl.Uniform1i(place("horizons"), 0);
            gl.Uniform2f(place("extent"), static_cast<float>(extent.width), static_cast<float>(extent.height));
            gl.Uniform3f(place("light"), static_cast<float>(level * std::cos(angle)),
                         static_cast<float>(level * std::sin(angle)), static_cast<float>(sun.sine));
        });
        ASSERT_FALSE(shaded.empty());
        const bool is_slice = sun.turn * kSlices == std::floor(sun.turn * kSlices);
        EXPECT_GE(agreement(field, peers::flipped(shaded, extent), sun), is_slice ? 1.0 : 0.9) << sun.turn;
    }
    gl.DeleteTextures(1, &texture);
    gl.DeleteProgram(program);
}

}  // namespace
