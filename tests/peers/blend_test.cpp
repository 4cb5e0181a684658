// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <tex/tex.h>

#include "blend_gl.h"
#include "software_gl.h"

namespace {

tex::MipChain waves(tex::Extent extent, double phase) {
    tex::NormalMap map(extent);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const double x = 0.8 * std::sin(0.4 * i + phase) + 0.3 * std::sin(1.1 * j);
            const double y = 0.8 * std::cos(0.3 * j - 0.2 * i + phase);
            const double length = std::sqrt(x * x + y * y + 1);
            map.x.at(i, j) = static_cast<float>(x / length);
            map.y.at(i, j) = static_cast<float>(y / length);
            map.z.at(i, j) = static_cast<float>(1 / length);
        }
    }
    auto chain = tex::build_mip_chain(std::move(map));
    EXPECT_TRUE(chain);
    return chain ? std::move(*chain) : tex::MipChain{};
}

struct Case {
    tex::Extent base, detail;
    float tiling_x, tiling_y, offset_x, offset_y;
    float base_scale, detail_scale;
};

// A shader samples the detail where blend() does, and mixes the same levels.
TEST(MesaBlend, GivesTheWhiteoutShadersNormals) {
    ASSERT_TRUE(peers::software_gl_works());
    const Case cases[] = {
        {{64, 64}, {64, 64}, 1, 1, 0, 0, 1, 1},
        {{128, 64}, {32, 32}, 2, 2, 0, 0, 1, 0.5f},  // magnified
        {{64, 64}, {16, 32}, 3.5f, 1.5f, 0.3f, -0.7f, 1.5f, 1},
        {{64, 48}, {61, 37}, 1, 1, 0.125f, 0.4f, 1, 2},      // odd
        {{64, 64}, {64, 64}, 2, 2, 0, 0, 1, 1},              // exactly level 1
        {{64, 64}, {64, 64}, 1.5f, 1.5f, 0.1f, 0.2f, 1, 1},  // between levels 0 and 1
        {{64, 64}, {128, 128}, 3, 1, 0, 0, 1, 1},            // longer one way than the other
    };
    for (const Case& c : cases) {
        const tex::MipChain base = waves(c.base, 0.0);
        const tex::MipChain detail = waves(c.detail, 1.0);
        const std::vector<float> theirs = peers::draw_whiteout(
            {&base, &detail, c.tiling_x, c.tiling_y, c.offset_x, c.offset_y, c.base_scale, c.detail_scale});
        ASSERT_FALSE(theirs.empty());
        tex::Layer layer;
        layer.detail = waves(c.detail, 1.0);
        layer.scale = c.detail_scale;
        layer.tiling_x = c.tiling_x;
        layer.tiling_y = c.tiling_y;
        layer.offset_x = c.offset_x;
        layer.offset_y = c.offset_y;
        tex::BlendOptions options;
        options.base_scale = c.base_scale;
        std::vector<tex::Layer> layers;
        layers.push_back(std::move(layer));
        const auto ours = tex::blend(waves(c.base, 0.0), std::move(layers), options);
        ASSERT_TRUE(ours);
        tex::NormalMap shader(c.base);
        for (int j = 0; j < c.base.height; ++j) {
            for (int i = 0; i < c.base.width; ++i) {
                const float* n = &theirs[4 * static_cast<std::size_t>(j * c.base.width + i)];
                shader.x.at(i, j) = n[0];
                shader.y.at(i, j) = n[1];
                shader.z.at(i, j) = n[2];
            }
        }
        const auto difference = tex::compare(*ours, shader);
        ASSERT_TRUE(difference);
        EXPECT_LE(difference->error.max, 0.05) << c.detail.width << "x" << c.detail.height << " tiled " << c.tiling_x
                                               << "x" << c.tiling_y << ", mean " << difference->error.mean;
    }
}

}  // namespace
