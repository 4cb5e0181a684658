// SPDX-License-Identifier: Apache-2.0
// The failures that tex_c.h promises, as rows: what the header says, and a call that does it. (tex_c_vectors_test.cpp
// has wrong arguments and small scratch.)

#include <tex/tex_c.h>

#include <sys/resource.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

#include <gtest/gtest.h>

namespace {

struct CFailure {
    const char* words;  // of the header
    int32_t promised, got;
};

void expect_codes(const std::vector<CFailure>& failures) {
    for (const CFailure& row : failures)
        EXPECT_EQ(row.got, row.promised) << row.words << ": " << tex_error_text(row.got);
}

// Eight by eight texels of everything.
struct Eight {
    std::vector<float> floats = std::vector<float>(3 * 64, 0.5f);
    std::vector<unsigned char> bytes = std::vector<unsigned char>(64 * 16, 0x80);

    tex_map map() { return {floats.data(), floats.data() + 64, floats.data() + 128, 8, 8, 8}; }
    tex_plane plane() { return {floats.data(), 8, 8, 8}; }
    tex_texels texels(int32_t format) { return {bytes.data(), tex_row_bytes(format, 8), format, 8, 8}; }
};

TEST(TexCFailures, OfTexels) {
    constexpr int32_t kNoFormat = 1000;
    Eight eight, result;
    tex_format_info info = {};
    info.size = sizeof info;
    const tex_texels rg = eight.texels(TEX_FORMAT_RG8_UNORM), bc5 = eight.texels(TEX_FORMAT_BC5_UNORM);
    const tex_texels nothing = eight.texels(kNoFormat);
    const tex_channels blue = {{nullptr, nullptr, result.floats.data(), nullptr}, 8};
    const tex_channels red = {{result.floats.data(), nullptr, nullptr, nullptr}, 8};
    const tex_channels narrow = {{result.floats.data(), nullptr, nullptr, nullptr}, 7};
    const tex_map map = result.map();
    const auto unpacked = [&](std::vector<std::uint8_t> swizzle) {
        tex_unpack_options options = TEX_UNPACK_OPTIONS;
        std::memcpy(options.swizzle, swizzle.data(), 4);
        return tex_unpack(&rg, &options, 0, 8, &map);
    };
    expect_codes({
        {"no such format", TEX_BAD_OPTION, tex_get_format(kNoFormat, &info)},
        {"no such format", TEX_BAD_OPTION, tex_get_format(-1, &info)},
        {"a channel that the format lacks", TEX_BAD_ARGUMENT, tex_decode(&rg, 0, 8, &blue)},
        {"a stride is too small", TEX_BAD_ARGUMENT, tex_decode(&rg, 0, 8, &narrow)},
        {"rows of whole blocks", TEX_BAD_ARGUMENT, tex_decode(&bc5, 2, 8, &red)},
        {"rows of whole blocks", TEX_BAD_ARGUMENT, tex_decode(&bc5, 0, 6, &red)},
        {"rows are outside", TEX_BAD_ARGUMENT, tex_decode(&bc5, 0, 12, &red)},
        {"the swizzle has no x", TEX_BAD_OPTION, unpacked({TEX_Y, TEX_Y, TEX_ZERO, TEX_ONE})},
        {"the swizzle has no y", TEX_BAD_OPTION, unpacked({TEX_X, TEX_ONE, TEX_ZERO, TEX_ONE})},
        {"one that the format lacks", TEX_BAD_OPTION, unpacked({TEX_X, TEX_ZERO, TEX_ZERO, TEX_Y})},
        {"the bytes of nothing", 0, static_cast<int32_t>(tex_row_bytes(kNoFormat, 8))},
        {"the bytes of too much", 0, static_cast<int32_t>(tex_row_bytes(TEX_FORMAT_R8_UNORM, 1048577))},
    });
    EXPECT_NE(tex_decode(&nothing, 0, 8, &red), TEX_OK);
}

TEST(TexCFailures, OfHeightsAndMeshes) {
    Eight eight, result;
    const tex_map map = eight.map();
    const tex_plane plane = result.plane();
    tex_integrate_options options = TEX_INTEGRATE_OPTIONS;
    std::vector<unsigned char> scratch(tex_integrate_size(8, 8, &options));
    const auto integrated = [&](float z) {
        for (std::size_t k = 128; k < 192; ++k) eight.floats[k] = z;
        return tex_integrate(&map, &options, &plane, nullptr, scratch.data(), scratch.size());
    };
    const auto hidden = [&](auto change, float height = 0.5f) {
        tex_occlusion_options with = TEX_OCCLUSION_OPTIONS;
        tex_occlusion_maps maps = {sizeof(tex_occlusion_maps), &plane, nullptr, nullptr, nullptr};
        change(with, maps);
        std::vector<float> heights(64, 0.5f);
        heights[13] = height;
        const tex_plane from = {heights.data(), 8, 8, 8};
        std::vector<unsigned char> memory(tex_occlusion_size(8, 8, &with));
        return tex_occlusion(&from, &with, &maps, memory.data(), memory.size());
    };
    const auto as_it_is = [](tex_occlusion_options&, tex_occlusion_maps&) {};
    EXPECT_EQ(hidden(as_it_is), TEX_OK);
    EXPECT_EQ(hidden(as_it_is, NAN), TEX_BAD_DATA);
    EXPECT_EQ(hidden([](auto& o, auto&) { o.directions = 3; }), TEX_BAD_OPTION);
    EXPECT_EQ(hidden([](auto& o, auto&) { o.maps = 8; }), TEX_BAD_OPTION);
    EXPECT_EQ(hidden([](auto& o, auto&) { o.maps = 0; }), TEX_BAD_OPTION);
    EXPECT_EQ(hidden([](auto& o, auto&) { o.horizons = 3; }), TEX_BAD_OPTION);
    EXPECT_EQ(hidden([](auto& o, auto&) { o.bumpiness_x = -1.0f; }), TEX_BAD_OPTION);
    EXPECT_EQ(hidden([](auto& o, auto&) { o.distance = INFINITY; }), TEX_BAD_OPTION);
    EXPECT_EQ(hidden([](auto& o, auto&) { o.maps = TEX_BENT; }), TEX_BAD_ARGUMENT);
    EXPECT_EQ(hidden([](auto& o, auto&) { o.horizons = 8; }), TEX_BAD_ARGUMENT);
    EXPECT_EQ(hidden([](auto&, auto& m) { m.size = 8; }), TEX_BAD_ARGUMENT);
    const float corners[] = {0, 0, 0, 1, 0, 0, 1, 1, 0}, normals[] = {0, 0, 1, 0, 0, 1, 0, 0, 1};
    const float uvs[] = {0, 0, 1, 0, 1, 1};
    std::uint32_t indices[] = {0, 1, 2};
    float tangents[12] = {};
    const auto meshed = [&](auto change) {
        tex_mesh mesh = {sizeof(tex_mesh), TEX_Y_UP, corners, normals, uvs, 0, 0, 0, 3, indices, 3};
        change(mesh);
        return tex_tangents(&mesh, TEX_MIKKTSPACE, tangents);
    };
    const float infinite[] = {0, 0, 0, 1, 0, 0, 1, INFINITY, 0};
    // Triangles that meet in one vertex, with tangents in opposite directions.
    std::vector<float> fan_corners, fan_normals, fan_uvs;
    std::vector<std::uint32_t> fan;
    for (std::uint32_t k = 0; k < 5000; ++k) {
        const float angle = 6.2831853f * static_cast<float>(k) / 5000.0f;
        for (const float c : {std::cos(angle), std::sin(angle), 0.0f}) fan_corners.push_back(k == 0 ? 0.0f : c);
        for (const float c : {0.0f, 0.0f, 1.0f}) fan_normals.push_back(c);
        for (const float c : {std::cos(3.0f * angle), std::sin(5.0f * angle)}) fan_uvs.push_back(k == 0 ? 0.0f : c);
        if (k > 1) fan.insert(fan.end(), {0, k - 1, k});
    }
    std::vector<float> fan_tangents(4 * fan.size());
    const tex_mesh turning = {
        sizeof(tex_mesh), TEX_Y_UP,  fan_corners.data(), fan_normals.data(), fan_uvs.data(), 0, 0, 0, 5000,
        fan.data(),       fan.size()};
    expect_codes({
        {"z is below 0", TEX_BAD_DATA, integrated(-0.7f)},
        {"no usable slope", TEX_BAD_DATA, integrated(0.0f)},
        {"tangents", TEX_OK, meshed([](tex_mesh&) {})},
        {"an index is out of range", TEX_BAD_DATA, meshed([](tex_mesh& mesh) { mesh.vertices = 2; })},
        {"a number is not finite", TEX_BAD_DATA, meshed([&](tex_mesh& mesh) { mesh.positions = infinite; })},
        {"there are no triangles", TEX_BAD_DATA, meshed([](tex_mesh& mesh) { mesh.index_count = 0; })},
        {"a multiple of 3", TEX_BAD_ARGUMENT, meshed([](tex_mesh& mesh) { mesh.index_count = 2; })},
        {"no such method", TEX_BAD_OPTION, tex_tangents(&turning, 2, fan_tangents.data())},
        {"more than 4096", TEX_UNSUPPORTED, tex_tangents(&turning, TEX_MESHOPT, fan_tangents.data())},
    });
}

// "A library that is older than the caller accepts a larger structure if what it does not know is 0."
TEST(TexCFailures, OfStructuresOfAnotherSize) {
    struct Newer {
        tex_bake_options options;
        int32_t later;
    } newer = {TEX_BAKE_OPTIONS, 0};
    newer.options.size = sizeof(tex_bake_options) + sizeof newer.later;
    Eight heights, result;
    const tex_plane plane = heights.plane();
    const tex_map map = result.map();
    const tex_bake_options known = TEX_BAKE_OPTIONS;
    std::vector<unsigned char> scratch(tex_bake_size(8, 8, &known));
    const auto bake = [&] { return tex_bake(&plane, &newer.options, 0, 8, &map, scratch.data(), scratch.size()); };
    EXPECT_EQ(bake(), TEX_OK);
    newer.later = 1;
    EXPECT_EQ(bake(), TEX_BAD_OPTION);
    EXPECT_EQ(tex_bake_size(8, 8, &newer.options), 0u);
    for (const std::uint32_t size : {std::uint32_t{sizeof(tex_bake_options)} - 1, 4097u, 0xFFFFFFFFu}) {
        newer.options.size = size;
        EXPECT_EQ(bake(), TEX_BAD_ARGUMENT) << size;
    }
    tex_format_info info;
    info.size = 0xFFFFFFFFu;
    EXPECT_EQ(tex_get_format(0, &info), TEX_BAD_ARGUMENT);
}

// What other tests of the process have prepared stays prepared, so these calls are made in a process of their own.
class TexCFailuresApart : public testing::Test {
protected:
    TexCFailuresApart() { testing::FLAGS_gtest_death_test_style = "threadsafe"; }

    // No more memory from the system than there is.
    static void take_memory_away() {
        const rlimit none = {1, 1};
        if (setrlimit(RLIMIT_AS, &none) != 0) std::_Exit(99);
    }
};

TEST_F(TexCFailuresApart, AstcThatIsNotPrepared) {
    Eight eight;
    const tex_map map = eight.map();
    tex_encode_options options = TEX_ENCODE_OPTIONS;
    options.encoding = TEX_ENCODING_ASTC_4X4;
    std::vector<unsigned char> blocks(64), scratch(tex_encode_size(8, &options));
    const auto encode = [&] {
        return tex_encode(&map, &options, 0, 8, blocks.data(), 32, scratch.data(), scratch.size());
    };
    EXPECT_EXIT(std::_Exit(encode()), testing::ExitedWithCode(TEX_NOT_PREPARED), "");
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they need memory themselves
TEST_F(TexCFailuresApart, MemoryThatRunsOut) {
    tex_encode_options options = TEX_ENCODE_OPTIONS;
    options.encoding = TEX_ENCODING_ASTC_8X8;
    options.effort = TEX_EFFORT_BEST;
    const auto prepare = [&] {
        take_memory_away();
        return tex_encode_prepare(&options);
    };
    EXPECT_EXIT(std::_Exit(prepare()), testing::ExitedWithCode(TEX_OUT_OF_MEMORY), "");

    const int32_t side = 1024;
    std::vector<unsigned char> bytes(tex_level_bytes(TEX_FORMAT_RGBA8_UNORM, side, side), 0x80);
    const tex_texels level = {bytes.data(), tex_row_bytes(TEX_FORMAT_RGBA8_UNORM, side), TEX_FORMAT_RGBA8_UNORM, side,
                              side};
    const auto check = [&] {
        take_memory_away();
        const tex_check_options any = TEX_CHECK_OPTIONS;
        std::size_t count = 0;
        return tex_check(&level, 1, &any, nullptr, 0, &count);
    };
    EXPECT_EXIT(std::_Exit(check()), testing::ExitedWithCode(TEX_OUT_OF_MEMORY), "");

    const std::size_t corners = 3 * 100000;
    std::vector<float> three(3 * corners, 1.0f), two(2 * corners, 0.5f), tangents(4 * corners);
    std::vector<std::uint32_t> indices(corners);
    for (std::size_t k = 0; k < corners; ++k) indices[k] = static_cast<std::uint32_t>(k);
    const tex_mesh mesh = {sizeof(tex_mesh), TEX_Y_UP,       three.data(), three.data(), two.data(), 0, 0, 0,
                           corners,          indices.data(), corners};
    const auto make = [&] {
        take_memory_away();
        return tex_tangents(&mesh, TEX_MIKKTSPACE, tangents.data());
    };
    EXPECT_EXIT(std::_Exit(make()), testing::ExitedWithCode(TEX_OUT_OF_MEMORY), "");
}
#endif

}  // namespace
