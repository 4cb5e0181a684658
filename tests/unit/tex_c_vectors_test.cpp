// SPDX-License-Identifier: Apache-2.0
// tex_c.h beside C++: normals to normals, heights, meshes, checks, and what is refused.

#include <tex/tex_c.h>

#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/tex.h>

#include "c_maps.h"
#include "fields.h"
#include "normal_maps.h"

namespace {

using tex::Extent;
using tex::c_maps::CallerMap;
using tex::c_maps::CallerPlane;
using tex::c_maps::ScratchMemory;

constexpr Extent kSizes[] = {{1, 1}, {2, 3}, {17, 9}, {130, 67}, {300, 5}};

TEST(TexCVectors, ScaleAsTheVerbDoesAlsoInPlace) {
    for (const Extent extent : kSizes) {
        for (const int32_t mode : {TEX_SCALE_SLOPE, TEX_SCALE_XY}) {
            const auto wanted = tex::scale(tex::wavy_map(extent), -1.75f, static_cast<tex::ScaleMode>(mode));
            CallerMap map(tex::wavy_map(extent));
            const tex_map view = map.view();
            ASSERT_EQ(tex_scale(&view, -1.75f, mode, 0, extent.height, &view), TEX_OK);
            map.expect(*wanted);
        }
    }
}

TEST(TexCVectors, BlendAsTheVerbDoes) {
    for (const Extent extent : kSizes) {
        for (int32_t mode = TEX_BLEND_WHITEOUT; mode <= TEX_BLEND_OVERLAY; ++mode) {
            for (const bool weighted : {false, true}) {
                SCOPED_TRACE(testing::Message() << extent.width << " mode " << mode << weighted);
                tex::Layer layer;
                layer.detail = tex::chain_from(tex::wavy_map(extent, 2.0));
                const auto mask = [&] {
                    return tex::fields::plane_of(extent,
                                                 [](int i, int j) { return 0.5 + 0.7 * std::sin(i + 3.0 * j); });
                };
                if (weighted) layer.mask = mask();
                std::vector<tex::Layer> layers;
                layers.push_back(std::move(layer));
                tex::BlendOptions verb;
                verb.mode = static_cast<tex::BlendMode>(mode);
                const auto wanted = tex::blend(tex::chain_from(tex::wavy_map(extent)), std::move(layers), verb);
                ASSERT_TRUE(wanted);
                CallerMap base(tex::wavy_map(extent)), detail(tex::wavy_map(extent, 2.0));
                CallerPlane weights(mask());
                const tex_map a = base.view(), b = detail.view();
                const tex_plane w = weights.view();
                // The verb makes both maps unit vectors first.
                ASSERT_EQ(tex_scale(&a, 1.0f, TEX_SCALE_SLOPE, 0, extent.height, &a), TEX_OK);
                ASSERT_EQ(tex_scale(&b, 1.0f, TEX_SCALE_SLOPE, 0, extent.height, &b), TEX_OK);
                ASSERT_EQ(tex_blend(&a, &b, weighted ? &w : nullptr, mode, 0, extent.height, &b), TEX_OK);
                detail.expect(*wanted);
            }
        }
    }
}

TEST(TexCVectors, AnglesAreThoseOfCompare) {
    for (const Extent extent : kSizes) {
        const tex::NormalMap p = tex::wavy_map(extent), q = tex::wavy_map(extent, 1.0);
        const auto wanted = tex::compare(p, q);
        ASSERT_TRUE(wanted);
        CallerMap a(p), b(q);
        CallerPlane degrees(extent);
        const tex_map from_a = a.view(), from_b = b.view();
        const tex_plane to = degrees.view();
        ASSERT_EQ(tex_angles(&from_a, &from_b, 0, extent.height, &to), TEX_OK);
        degrees.expect(wanted->degrees, 0, extent.height);
    }
}

TEST(TexCSurface, DebandsAsTheVerbDoes) {
    for (const Extent extent : {Extent{1, 1}, Extent{40, 31}, Extent{257, 130}, Extent{64, 300}, Extent{2000, 3}}) {
        for (const int32_t wrap : {TEX_REPEAT, TEX_CLAMP, TEX_MIRROR}) {
            SCOPED_TRACE(testing::Message() << extent.width << "x" << extent.height << " wrap " << wrap);
            tex::HeightField field;
            field.height = tex::fields::plane_of(extent, [](int i, int j) {
                return std::round(127.0 + 60.0 * std::sin(0.03 * i) + 40.0 * std::cos(0.021 * j)) / 255.0;
            });
            CallerPlane heights(field.height);
            field.wrap_x = field.wrap_y = static_cast<tex::Wrap>(wrap);
            const auto wanted = tex::deband(std::move(field));
            ASSERT_TRUE(wanted);
            const tex_plane plane = heights.view();
            tex_deband_report report = {};
            report.size = sizeof report;
            ScratchMemory scratch(tex_deband_size(extent.width, extent.height));
            ASSERT_EQ(tex_deband(&plane, wrap, wrap, 1, &report, scratch.data(), scratch.size()), TEX_OK);
            heights.expect(wanted->height, 0, extent.height);
            EXPECT_EQ(report.applied == 1, wanted->report.applied);
            EXPECT_EQ(report.codes, wanted->report.codes);
            EXPECT_EQ(report.terrace_texels, wanted->report.terrace_texels);
        }
    }
}

TEST(TexCSurface, IntegratesAsTheVerbDoes) {
    for (const Extent extent : {Extent{1, 1}, Extent{16, 16}, Extent{37, 64}, Extent{257, 131}, Extent{1021, 2}}) {
        for (const int32_t kernel : {TEX_KERNEL_FORWARD, TEX_KERNEL_CENTRAL, TEX_KERNEL_SOBEL5, TEX_KERNEL_GAUSSIAN}) {
            for (const int32_t wrap : {TEX_REPEAT, TEX_CLAMP, TEX_MIRROR}) {
                SCOPED_TRACE(testing::Message()
                             << extent.width << "x" << extent.height << " kernel " << kernel << " wrap " << wrap);
                tex::IntegrateOptions verb;
                verb.bake = {static_cast<tex::GradientKernel>(kernel), 1.25f};
                verb.wrap_x = verb.wrap_y = static_cast<tex::Wrap>(wrap);
                verb.bumpiness_x = verb.bumpiness_y = 3.0f;
                const tex::NormalMap map = tex::wavy_map(extent);
                const auto wanted = tex::integrate(map, verb);
                ASSERT_TRUE(wanted);
                tex_integrate_options options = TEX_INTEGRATE_OPTIONS;
                options.kernel = kernel;
                options.gaussian_sigma = 1.25f;
                options.wrap_x = options.wrap_y = wrap;
                options.bumpiness_x = options.bumpiness_y = 3.0f;
                CallerMap normals(map);
                CallerPlane heights(extent);
                const tex_map from = normals.view();
                const tex_plane to = heights.view();
                tex_integrate_report report = {};
                report.size = sizeof report;
                ScratchMemory scratch(tex_integrate_size(extent.width, extent.height, &options));
                ASSERT_EQ(tex_integrate(&from, &options, &to, &report, scratch.data(), scratch.size()), TEX_OK);
                heights.expect(wanted->field.height, 0, extent.height);
                EXPECT_EQ(report.highest, wanted->highest);
                EXPECT_EQ(report.steps, wanted->steps);
            }
        }
    }
}

TEST(TexCSurface, OcclusionIsThatOfTheVerb) {
    for (const Extent extent : {Extent{1, 1}, Extent{16, 16}, Extent{37, 64}, Extent{257, 131}, Extent{300, 2}}) {
        for (const int32_t wrap : {TEX_REPEAT, TEX_CLAMP, TEX_MIRROR}) {
            SCOPED_TRACE(testing::Message() << extent.width << "x" << extent.height << " wrap " << wrap);
            const tex::HeightField field = tex::fields::field_of(
                extent, 6.0f, static_cast<tex::Wrap>(wrap),
                [](int i, int j) { return std::sin(0.3 * i) * std::cos(0.21 * j) + 0.2 * tex::fields::noise(i, j); });
            const auto wanted =
                tex::occlusion(field, {12, 30.0f, true, true, true, 5}, {tex::GradientKernel::sobel5, 1.0f});
            ASSERT_TRUE(wanted);
            tex_occlusion_options options = TEX_OCCLUSION_OPTIONS;
            options.kernel = TEX_KERNEL_SOBEL5;
            options.bumpiness_x = options.bumpiness_y = 6.0f;
            options.wrap_x = options.wrap_y = wrap;
            options.maps = TEX_OCCLUSION | TEX_SKY_VIEW | TEX_BENT;
            options.directions = 12;
            options.distance = 30.0f;
            options.horizons = 5;
            CallerPlane heights(field.height), occlusion(extent), sky(extent);
            CallerMap bent(extent);
            std::vector<CallerPlane> horizons;
            std::vector<tex_plane> places;
            for (int k = 0; k < 5; ++k) horizons.emplace_back(extent);
            for (CallerPlane& plane : horizons) places.push_back(plane.view());
            const tex_plane from = heights.view(), to = occlusion.view(), to_sky = sky.view();
            const tex_map to_bent = bent.view();
            const tex_occlusion_maps maps = {sizeof(tex_occlusion_maps), &to, &to_sky, &to_bent, places.data()};
            ScratchMemory scratch(tex_occlusion_size(extent.width, extent.height, &options));
            ASSERT_EQ(tex_occlusion(&from, &options, &maps, scratch.data(), scratch.size()), TEX_OK);
            occlusion.expect(wanted->occlusion, 0, extent.height);
            sky.expect(wanted->sky_view, 0, extent.height);
            bent.expect(wanted->bent);
            for (std::size_t k = 0; k < 5; ++k) horizons[k].expect(wanted->horizons[k], 0, extent.height);
        }
    }
}

TEST(TexCSurface, AMapWithoutSlopesIsBadData) {
    CallerMap normals(tex::uniform_map({8, 8}, 0.0f, 0.6f, -0.8f));
    CallerPlane heights({8, 8});
    const tex_map from = normals.view();
    const tex_plane to = heights.view();
    const tex_integrate_options options = TEX_INTEGRATE_OPTIONS;
    ScratchMemory scratch(tex_integrate_size(8, 8, &options));
    EXPECT_EQ(tex_integrate(&from, &options, &to, nullptr, scratch.data(), scratch.size()), TEX_BAD_DATA);
}

// Two triangles in the plane z = 0, interleaved.
struct Quad {
    float vertices[4][8] = {
        {0, 0, 0, 0, 0, 1, 0, 0}, {1, 0, 0, 0, 0, 1, 1, 0}, {1, 1, 0, 0, 0, 1, 1, 1}, {0, 1, 0, 0, 0, 1, 0, 1}};
    std::uint32_t indices[6] = {0, 1, 2, 0, 2, 3};

    [[nodiscard]] tex_mesh mesh() const {
        const std::size_t step = sizeof vertices[0];
        return {sizeof(tex_mesh), TEX_Y_DOWN, vertices[0], vertices[0] + 3, vertices[0] + 6, step, step, step, 4,
                indices,          6};
    }
};

TEST(TexCMesh, TangentsPointToGreaterU) {
    const Quad quad;
    const tex_mesh mesh = quad.mesh();
    float tangents[6][4] = {};
    for (const int32_t method : {TEX_MIKKTSPACE, TEX_MESHOPT}) {
        ASSERT_EQ(tex_tangents(&mesh, method, tangents[0]), TEX_OK);
        for (const auto& tangent : tangents) {
            EXPECT_FLOAT_EQ(tangent[0], 1.0f);
            EXPECT_FLOAT_EQ(tangent[1], 0.0f);
            EXPECT_FLOAT_EQ(tangent[3], -1.0f);  // v points down, and v grows with y
        }
    }
    tex_mesh broken = mesh;
    broken.vertices = 3;
    EXPECT_EQ(tex_tangents(&broken, TEX_MIKKTSPACE, tangents[0]), TEX_BAD_DATA);
}

TEST(TexCCheck, FindsWhatTheVerbFinds) {
    tex::PackOptions pack;
    pack.encoding = tex::Encoding::rgb8;
    auto texture = tex::pack(tex::chain_from(tex::uniform_map({64, 64}, 0.5f, 0.1f, 0.3f)), pack);
    ASSERT_TRUE(texture);
    const auto wanted = tex::check({}, *texture);
    ASSERT_TRUE(wanted);
    ASSERT_FALSE(wanted->findings.empty());
    const tex_texels level = {texture->levels[0].bytes.data(), 64 * 3, TEX_FORMAT_RGB8_UNORM, 64, 64};
    tex_check_options options = TEX_CHECK_OPTIONS;
    options.swizzle[0] = TEX_X;
    options.swizzle[1] = TEX_Y;
    options.swizzle[2] = TEX_Z;
    options.swizzle[3] = TEX_OTHER;
    tex_finding findings[64] = {};
    findings[0].size = sizeof(tex_finding);
    std::size_t count = 0;
    ASSERT_EQ(tex_check(&level, 1, &options, findings, 64, &count), TEX_OK);
    ASSERT_EQ(count, wanted->findings.size());
    for (std::size_t k = 0; k < count; ++k) {
        EXPECT_EQ(findings[k].id, std::string(wanted->findings[k].rule->id));
        EXPECT_EQ(findings[k].severity, static_cast<int32_t>(wanted->findings[k].severity));
        EXPECT_EQ(wanted->findings[k].message.rfind(findings[k].message, 0), 0u);
    }
    EXPECT_EQ(tex_check(&level, 1, &options, nullptr, 0, &count), TEX_OK) << "counts alone";
}

TEST(TexCAbi, StructuresOfANewerCallerAreReadIfWhatIsNewIsZero) {
    struct Newer {
        tex_bake_options known = TEX_BAKE_OPTIONS;
        std::int32_t added = 0;
    } options;
    options.known.size = sizeof options;
    EXPECT_GT(tex_bake_size(8, 8, &options.known), 0u);
    options.added = 1;
    EXPECT_EQ(tex_bake_size(8, 8, &options.known), 0u);
    options.known.size = sizeof(tex_bake_options) - 4;
    EXPECT_EQ(tex_bake_size(8, 8, &options.known), 0u) << "smaller than that of the first version";
}

TEST(TexCAbi, LayoutsAreThoseOfTheFirstVersion) {
    static_assert(sizeof(tex_plane) == 24 && sizeof(tex_map) == 40 && sizeof(tex_channels) == 40);
    static_assert(sizeof(tex_texels) == 32 && sizeof(tex_format_info) == 28);
    static_assert(sizeof(tex_bake_options) == 28 && sizeof(tex_mip_options) == 32 && sizeof(tex_encode_options) == 20);
    static_assert(sizeof(tex_unpack_options) == 28 && sizeof(tex_integrate_options) == 40);
    static_assert(sizeof(tex_deband_report) == 24 && sizeof(tex_integrate_report) == 24);
    static_assert(sizeof(tex_mesh) == 80 && sizeof(tex_finding) == 280 && sizeof(tex_check_options) == 16);
    static_assert(offsetof(tex_finding, message) == 48 && offsetof(tex_mesh, indices) == 64);
}

TEST(TexCAbi, ErrorsHaveTexts) {
    for (int32_t code = TEX_OK; code <= TEX_NOT_PREPARED; ++code) EXPECT_STRNE(tex_error_text(code), "unknown error");
    EXPECT_STREQ(tex_error_text(-1), "unknown error");
    EXPECT_STREQ(tex_error_text(99), "unknown error");
    EXPECT_STREQ(tex_version(), tex::version());
}

TEST(TexCRefuses, WrongArgumentsAndSmallScratch) {
    CallerMap map(tex::wavy_map({20, 10}));
    CallerPlane plane({20, 10});
    const tex_map good = map.view();
    const tex_plane heights = plane.view();
    const tex_bake_options bake = TEX_BAKE_OPTIONS;
    ScratchMemory scratch(tex_bake_size(20, 10, &bake));
    EXPECT_EQ(tex_bake(nullptr, &bake, 0, 10, &good, scratch.data(), scratch.size()), TEX_BAD_ARGUMENT);
    EXPECT_EQ(tex_bake(&heights, nullptr, 0, 10, &good, scratch.data(), scratch.size()), TEX_BAD_ARGUMENT);
    EXPECT_EQ(tex_bake(&heights, &bake, 0, 11, &good, scratch.data(), scratch.size()), TEX_BAD_ARGUMENT);
    EXPECT_EQ(tex_bake(&heights, &bake, -1, 10, &good, scratch.data(), scratch.size()), TEX_BAD_ARGUMENT);
    EXPECT_EQ(tex_bake(&heights, &bake, 0, 10, &good, scratch.data(), scratch.size() - 1), TEX_SCRATCH_TOO_SMALL);
    EXPECT_EQ(tex_bake(&heights, &bake, 0, 10, &good, nullptr, scratch.size()), TEX_BAD_ARGUMENT);
    tex_map narrow = good;
    narrow.stride = 19;
    EXPECT_EQ(tex_scale(&narrow, 1.0f, TEX_SCALE_SLOPE, 0, 10, &good), TEX_BAD_ARGUMENT);
    EXPECT_EQ(tex_scale(&good, 1e7f, TEX_SCALE_SLOPE, 0, 10, &good), TEX_BAD_OPTION);
    EXPECT_EQ(tex_scale(&good, 1.0f, 2, 0, 10, &good), TEX_BAD_OPTION);
    EXPECT_EQ(tex_blend(&good, &good, nullptr, 6, 0, 10, &good), TEX_BAD_OPTION);
    tex_encode_options encode = TEX_ENCODE_OPTIONS;
    unsigned char blocks[5 * 3 * 16];
    EXPECT_EQ(tex_encode(&good, &encode, 2, 10, blocks, 80, nullptr, 0), TEX_BAD_ARGUMENT) << "not a row of blocks";
    EXPECT_EQ(tex_encode(&good, &encode, 0, 10, blocks, 79, nullptr, 0), TEX_BAD_ARGUMENT);
    encode.effort = 3;
    EXPECT_EQ(tex_encode(&good, &encode, 0, 10, blocks, 80, nullptr, 0), TEX_BAD_OPTION);
    EXPECT_EQ(tex_encoding_format(99), -1);
    EXPECT_EQ(tex_level_bytes(TEX_FORMAT_BC5_UNORM, 0, 1), 0u);
}

}  // namespace
