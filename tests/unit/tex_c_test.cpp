// SPDX-License-Identifier: Apache-2.0
// The functions of tex_c.h give the bytes of the verbs of C++, in the memory of a caller, with exactly the scratch that
// they state.

#include <tex/tex_c.h>

#include <cstring>
#include <limits>
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
using tex::c_maps::Guarded;
using tex::c_maps::ScratchMemory;

constexpr Extent kExtents[] = {{1, 1}, {2, 3}, {15, 4}, {16, 16}, {17, 9}, {33, 21}, {130, 67}, {257, 48}};
constexpr int32_t kWraps[] = {TEX_REPEAT, TEX_CLAMP, TEX_MIRROR};

tex::HeightField hills(Extent extent, tex::Wrap wrap_x, tex::Wrap wrap_y) {
    tex::HeightField field;
    field.height = tex::fields::plane_of(
        extent, [](int i, int j) { return std::sin(0.37 * i) * std::cos(0.21 * j) + 0.1 * std::sin(2.1 * i + j); });
    field.bumpiness_x = 3.5f;
    field.bumpiness_y = -2.25f;
    field.wrap_x = wrap_x;
    field.wrap_y = wrap_y;
    return field;
}

void expect_same_bake(Extent extent, int32_t kernel, int32_t wrap_x, int32_t wrap_y) {
    SCOPED_TRACE(testing::Message() << extent.width << "x" << extent.height << " kernel " << kernel << " wraps "
                                    << wrap_x << wrap_y);
    const tex::HeightField field = hills(extent, static_cast<tex::Wrap>(wrap_x), static_cast<tex::Wrap>(wrap_y));
    const auto wanted = tex::bake(field, {static_cast<tex::GradientKernel>(kernel), 1.5f});
    ASSERT_TRUE(wanted);
    CallerPlane heights(field.height);
    CallerMap out(extent);
    tex_bake_options options = TEX_BAKE_OPTIONS;
    options.kernel = kernel;
    options.gaussian_sigma = 1.5f;
    options.bumpiness_x = field.bumpiness_x;
    options.bumpiness_y = field.bumpiness_y;
    options.wrap_x = wrap_x;
    options.wrap_y = wrap_y;
    ScratchMemory scratch(tex_bake_size(extent.width, extent.height, &options));
    const tex_plane from = heights.view();
    const tex_map to = out.view();
    const int middle = extent.height / 3;  // the rows of two callers, the lower ones first
    ASSERT_EQ(tex_bake(&from, &options, middle, extent.height, &to, scratch.data(), scratch.size()), TEX_OK);
    ASSERT_EQ(tex_bake(&from, &options, 0, middle, &to, scratch.data(), scratch.size()), TEX_OK);
    out.expect(*wanted);
}

TEST(TexC, BakesAsTheVerbDoes) {
    for (const Extent extent : kExtents) {
        for (int32_t kernel = TEX_KERNEL_FORWARD; kernel <= TEX_KERNEL_GAUSSIAN; ++kernel) {
            for (const int32_t wrap : kWraps) expect_same_bake(extent, kernel, wrap, (wrap + 1) % 3);
        }
    }
}

TEST(TexC, ABakeOfHeightsThatAreNotFiniteFails) {
    CallerPlane heights(hills({40, 9}, tex::Wrap::clamp, tex::Wrap::clamp).height);
    CallerMap out({40, 9});
    heights.row(8)[39] = std::numeric_limits<float>::infinity();
    tex_bake_options options = TEX_BAKE_OPTIONS;
    options.wrap_y = TEX_CLAMP;
    ScratchMemory scratch(tex_bake_size(40, 9, &options));
    const tex_plane from = heights.view();
    const tex_map to = out.view();
    EXPECT_EQ(tex_bake(&from, &options, 0, 9, &to, scratch.data(), scratch.size()), TEX_BAD_DATA);
    EXPECT_EQ(tex_bake(&from, &options, 0, 7, &to, scratch.data(), scratch.size()), TEX_OK) << "row 8 is not read";
}

void expect_same_chain(Extent extent, const tex_mip_options& options) {
    SCOPED_TRACE(testing::Message() << extent.width << "x" << extent.height << " filter " << options.filter
                                    << " domain " << options.domain);
    tex::MipOptions verb;
    verb.filter = static_cast<tex::MipFilter>(options.filter);
    verb.domain = static_cast<tex::MipDomain>(options.domain);
    verb.wrap_x = static_cast<tex::Wrap>(options.wrap_x);
    verb.wrap_y = static_cast<tex::Wrap>(options.wrap_y);
    if (options.fade_last > 0) verb.fade = tex::Fade{options.fade_first, options.fade_last};
    const auto wanted = tex::build_mip_chain(tex::wavy_map(extent), verb);
    ASSERT_TRUE(wanted);
    std::vector<CallerMap> maps;
    maps.emplace_back(tex::wavy_map(extent));
    for (std::size_t k = 1; k < wanted->levels.size(); ++k) maps.emplace_back(wanted->levels[k].extent());
    const auto count = static_cast<int32_t>(maps.size());
    const auto finish = [&](int32_t level) {
        const tex_map map = maps[static_cast<std::size_t>(level)].view();
        if (level == 0) return;
        EXPECT_EQ(tex_mip_finish(&map, level, &options, 0, map.height), TEX_OK);
    };
    for (int32_t level = 0; level + 1 < count; ++level) {
        const tex_map from = maps[static_cast<std::size_t>(level)].view();
        const tex_map to = maps[static_cast<std::size_t>(level) + 1].view();
        ScratchMemory scratch(tex_mip_size(from.width, from.height, &options));
        const int32_t half = to.height / 2;
        ASSERT_EQ(tex_mip_level(&from, level, &options, half, to.height, &to, scratch.data(), scratch.size()), TEX_OK);
        ASSERT_EQ(tex_mip_level(&from, level, &options, 0, half, &to, scratch.data(), scratch.size()), TEX_OK);
        finish(level);
    }
    finish(count - 1);
    for (std::size_t k = 0; k < maps.size(); ++k) maps[k].expect(wanted->levels[k]);
}

TEST(TexC, MakesTheLevelsOfTheVerb) {
    for (const Extent extent : kExtents) {
        for (int32_t filter = TEX_FILTER_BOX; filter <= TEX_FILTER_LANCZOS3; ++filter) {
            for (const int32_t domain : {TEX_DOMAIN_VECTOR, TEX_DOMAIN_SLOPE}) {
                tex_mip_options options = TEX_MIP_OPTIONS;
                options.filter = filter;
                options.domain = domain;
                options.wrap_x = filter % 3;
                options.wrap_y = (filter + domain) % 3;
                if (filter == TEX_FILTER_TRIANGLE) options.fade_last = 3;
                expect_same_chain(extent, options);
            }
        }
    }
}

void expect_same_texture(Extent extent, int32_t encoding, int32_t effort) {
    SCOPED_TRACE(testing::Message() << extent.width << "x" << extent.height << " encoding " << encoding << " effort "
                                    << effort);
    tex::PackOptions verb;
    verb.encoding = static_cast<tex::Encoding>(encoding);
    verb.effort = static_cast<tex::Effort>(effort);
    verb.y_axis = tex::YAxis::down;
    const auto wanted = tex::pack(tex::chain_from(tex::wavy_map(extent)), verb);
    ASSERT_TRUE(wanted);
    tex_encode_options options = TEX_ENCODE_OPTIONS;
    options.encoding = encoding;
    options.effort = effort;
    options.y_axis = TEX_Y_DOWN;
    CallerMap normals(tex::wavy_map(extent));
    const tex_map map = normals.view();
    const int32_t format = tex_encoding_format(encoding);
    tex_format_info info = {};
    info.size = sizeof info;
    ASSERT_EQ(tex_get_format(format, &info), TEX_OK);
    const std::size_t row = tex_row_bytes(format, extent.width), pitch = row + 5;
    const int rows = (extent.height + info.block_height - 1) / info.block_height;
    Guarded<unsigned char> bytes(pitch * static_cast<std::size_t>(rows - 1) + row, 0xcd);
    ASSERT_EQ(tex_encode_prepare(&options), TEX_OK);
    ScratchMemory scratch(tex_encode_size(extent.width, &options));
    const int32_t middle = rows / 2 * info.block_height;
    ASSERT_EQ(tex_encode(&map, &options, middle, extent.height, bytes.data(), pitch, scratch.data(), scratch.size()),
              TEX_OK);
    ASSERT_EQ(tex_encode(&map, &options, 0, middle, bytes.data(), pitch, scratch.data(), scratch.size()), TEX_OK);
    const std::vector<std::byte>& right = wanted->levels[0].bytes;
    ASSERT_EQ(tex_level_bytes(format, extent.width, extent.height), right.size());
    for (int r = 0; r < rows; ++r) {
        const unsigned char* const found = bytes.data() + pitch * static_cast<std::size_t>(r);
        EXPECT_EQ(std::memcmp(found, right.data() + row * static_cast<std::size_t>(r), row), 0) << "row " << r;
        for (int k = 0; r + 1 < rows && k < 5; ++k) EXPECT_EQ(found[row + static_cast<std::size_t>(k)], 0xcd);
    }
}

TEST(TexC, EncodesAsTheVerbPacks) {
    for (const Extent extent : kExtents) {
        for (const auto& row : tex::kEncodingNames)
            expect_same_texture(extent, static_cast<int32_t>(row.value), TEX_EFFORT_NORMAL);
    }
    for (const auto& row : tex::kEncodingNames) {
        const tex::Encoding encoding = row.value;
        if (!tex::format_info(tex::encoding_info(encoding).format).has_blocks()) continue;
        expect_same_texture({70, 21}, static_cast<int32_t>(encoding), TEX_EFFORT_FAST);
        expect_same_texture({70, 21}, static_cast<int32_t>(encoding), TEX_EFFORT_BEST);
    }
}

// Any bytes of a format: those of blocks decode, and floats become NaN here and there.
tex::Texture any_texture(tex::Format format, Extent extent) {
    tex::Texture texture;
    texture.format = format;
    tex::Level level;
    level.extent = extent;
    level.bytes.resize(tex::level_bytes(format, extent));
    std::uint32_t state = 12345;
    for (std::byte& byte : level.bytes) byte = static_cast<std::byte>((state = state * 1664525u + 1013904223u) >> 24);
    texture.levels.push_back(std::move(level));
    return texture;
}

// The bytes of its base level, and how C sees them.
struct CallerTexels {
    explicit CallerTexels(const tex::Texture& texture)
        : bytes(texture.levels[0].bytes.size(), std::byte{0}), format(static_cast<int32_t>(texture.format)),
          extent(texture.levels[0].extent) {
        std::copy(texture.levels[0].bytes.begin(), texture.levels[0].bytes.end(), bytes.data());
    }
    [[nodiscard]] tex_texels view() {
        return {bytes.data(), tex_row_bytes(format, extent.width), format, extent.width, extent.height};
    }

    Guarded<std::byte> bytes;
    int32_t format;
    Extent extent;
};

TEST(TexC, DecodesEveryFormatAsTheVerbDoes) {
    for (const auto& format : tex::kFormatNames) {
        for (const Extent extent : kExtents) {
            SCOPED_TRACE(testing::Message() << format.name << " " << extent.width << "x" << extent.height);
            const tex::Texture texture = any_texture(format.value, extent);
            const auto wanted = tex::decode(texture, 0);
            ASSERT_TRUE(wanted);
            std::vector<CallerPlane> planes(wanted->planes.size(), CallerPlane(extent));
            tex_channels out = {};
            out.stride = planes[0].stride;
            for (std::size_t c = 0; c < planes.size(); ++c) out.channel[c] = planes[c].floats.data();
            CallerTexels stored(texture);
            const tex_texels texels = stored.view();
            ASSERT_EQ(tex_decode(&texels, 0, extent.height, &out), TEX_OK);
            for (std::size_t c = 0; c < planes.size(); ++c) planes[c].expect(wanted->planes[c], 0, extent.height);
        }
    }
}

TEST(TexC, UnpacksEveryFormatAsTheVerbDoes) {
    for (const auto& format : tex::kFormatNames) {
        if (tex::format_info(format.value).channels < 2) continue;
        for (const Extent extent : kExtents) {
            SCOPED_TRACE(testing::Message() << format.name << " " << extent.width << "x" << extent.height);
            tex::Texture texture = any_texture(format.value, extent);
            texture.swizzle = tex::format_info(format.value).channels == 2 ? tex::kSwizzleXy : tex::kSwizzleXyz;
            tex::UnpackOptions verb;
            verb.range = tex::ValueRange::unsigned_;
            verb.y_axis = tex::YAxis::down;
            verb.snap_flat = true;
            const auto wanted = tex::unpack(texture, verb);
            ASSERT_TRUE(wanted);
            tex_unpack_options options = TEX_UNPACK_OPTIONS;
            options.range = TEX_RANGE_UNSIGNED;
            options.y_axis = TEX_Y_DOWN;
            options.snap_flat = 1;
            CallerMap out(extent);
            const tex_map to = out.view();
            CallerTexels stored(texture);
            const tex_texels texels = stored.view();
            ASSERT_EQ(tex_unpack(&texels, &options, 0, extent.height, &to), TEX_OK);
            out.expect(wanted->levels[0]);
        }
    }
}

}  // namespace
