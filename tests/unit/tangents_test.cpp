// SPDX-License-Identifier: Apache-2.0

#include <tex/mesh.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "unit/meshes.h"

namespace tex {
namespace {

namespace fs = std::filesystem;

// What tests/peers/tangents.mjs reads: the attributes of all corners, as floats: x y z, x y z, u v.
void dump_corners(const MeshPart& part, const std::string& name) {
    const char* folder = std::getenv("TEX_TANGENTS_DUMP");
    if (folder == nullptr) return;
    std::ofstream file(fs::path(folder) / (name + ".corners"), std::ios::binary);
    const auto put = [&](float value) { file.write(reinterpret_cast<const char*>(&value), sizeof value); };
    for (const std::uint32_t v : part.indices) {
        const Float3 &p = part.positions[v], &n = part.normals[v];
        const Float2& uv = part.uvs[0][v];
        for (const float value : {p.x, p.y, p.z, n.x, n.y, n.z, uv.x, uv.y}) put(value);
    }
}

// FNV-1a of the bits of tangents, with w as both libraries write it: v points up.
std::string digest(const std::vector<Float4>& tangents, YAxis v_axis) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const Float4& t : tangents) {
        for (const float value : {t.x, t.y, t.z, v_axis == YAxis::up ? t.w : -t.w}) {
            const float plain = value == 0.0f ? 0.0f : value;  // not -0
            std::uint32_t bits = 0;
            std::memcpy(&bits, &plain, sizeof bits);
            for (int shift = 0; shift < 32; shift += 8) hash = (hash ^ (bits >> shift & 0xff)) * 0x100000001b3u;
        }
    }
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
    return text;
}

// Rows of tests/golden/tangents.txt: name, corners, digests of mikktspace and meshopt.
struct Golden {
    std::size_t corners = 0;
    std::string mikktspace, meshopt;
};

std::map<std::string, Golden> golden_rows() {
    std::map<std::string, Golden> rows;
    std::ifstream file(TEX_SOURCE_DIR "/tests/golden/tangents.txt");
    for (std::string line; std::getline(file, line);) {
        if (line.empty() || line[0] == '#') continue;
        std::istringstream words(line);
        std::string name;
        Golden row;
        words >> name >> row.corners >> row.mikktspace >> row.meshopt;
        rows[name] = row;
    }
    return rows;
}

void expect_golden(const MeshPart& part, const std::string& name, const std::map<std::string, Golden>& rows) {
    SCOPED_TRACE(name);
    ASSERT_TRUE(check_part(part)) << check_part(part).error().message();
    dump_corners(part, name);
    const auto mikktspace = make_tangents(part, TangentMethod::mikktspace);
    const auto meshopt = make_tangents(part, TangentMethod::meshopt);
    ASSERT_TRUE(mikktspace && meshopt);
    if (std::getenv("TEX_TANGENTS_DUMP") != nullptr) return;
    const auto row = rows.find(name);
    ASSERT_NE(row, rows.end());
    EXPECT_EQ(part.indices.size(), row->second.corners);
    EXPECT_EQ(digest(*mikktspace, part.v_axis), row->second.mikktspace);
    EXPECT_EQ(digest(*meshopt, part.v_axis), row->second.meshopt);
}

TEST(TangentsGolden, AreThoseOfBothLibrariesToTheLastBitOnTwoHundredRandomMeshes) {
    const auto rows = golden_rows();
    for (unsigned seed = 1; seed <= 200; ++seed)
        expect_golden(random_part(seed), "random-" + std::to_string(seed), rows);
}

TEST(TangentsGolden, AreThoseOfBothLibrariesToTheLastBitOnSheets) {
    const auto rows = golden_rows();
    expect_golden(wavy_part(24), "sheet", rows);
    expect_golden(wavy_part(24, true), "mirrored-sheet", rows);
}

TEST(TangentsGolden, AreThoseOfBothLibrariesToTheLastBitOnRealMeshes) {
    const fs::path folder = TEX_SOURCE_DIR "/../shared/data/mesh";
    if (!fs::exists(folder)) GTEST_SKIP() << "no shared data";
    const auto rows = golden_rows();
    std::size_t meshes = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        const std::string kind = entry.path().extension();
        if (kind != ".gltf" && kind != ".glb" && kind != ".obj") continue;
        const auto mesh = read_mesh(entry.path());
        ASSERT_TRUE(mesh) << mesh.error().message();
        for (std::size_t k = 0; k < mesh->parts.size(); ++k) {
            const MeshPart& part = mesh->parts[k];
            if (part.normals.empty() || part.uvs.empty()) continue;
            expect_golden(part, entry.path().filename().string() + "-" + std::to_string(k), rows);
            ++meshes;
        }
    }
    EXPECT_GE(meshes, 12u);
}

TEST(Tangents, AreTheSameForEveryNumberOfThreads) {
    const MeshPart part = wavy_part(150, true);
    for (const TangentMethod method : {TangentMethod::mikktspace, TangentMethod::meshopt}) {
        const auto one = make_tangents(part, method, 0, {1, {}});
        for (const int threads : {2, 3, 7}) {
            const auto many = make_tangents(part, method, 0, {threads, {}});
            ASSERT_TRUE(one && many);
            EXPECT_EQ(std::memcmp(one->data(), many->data(), one->size() * sizeof(Float4)), 0);
        }
    }
}

TEST(Tangents, PointToGreaterUAndBitangentsUp) {
    for (const YAxis v_axis : {YAxis::up, YAxis::down}) {
        MeshPart part = wavy_part(8);
        if (v_axis == YAxis::down) {
            for (Float2& uv : part.uvs[0]) uv.y = 1.0f - uv.y;
        }
        part.v_axis = v_axis;
        for (const TangentMethod method : {TangentMethod::mikktspace, TangentMethod::meshopt}) {
            const auto tangents = make_tangents(part, method);
            ASSERT_TRUE(tangents);
            for (const Float4& t : *tangents) {
                EXPECT_GT(t.x, 0.75f);
                EXPECT_EQ(t.w, 1.0f);  // cross(N, T) points to +y, which is up in the picture
            }
        }
    }
}

TEST(Tangents, SplitWhereUvsAreMirrored) {
    const MeshPart part = wavy_part(8, true);
    const auto tangents = make_tangents(part);
    ASSERT_TRUE(tangents);
    for (std::size_t c = 0; c < part.indices.size(); ++c) {
        const std::size_t first = c - c % 3;
        const float middle = (part.positions[part.indices[first]].x + part.positions[part.indices[first + 1]].x +
                              part.positions[part.indices[first + 2]].x) /
                             3.0f;
        EXPECT_EQ((*tangents)[c].w, middle < 0.5f ? 1.0f : -1.0f);
    }
}

TEST(Tangents, RefuseMeshesWithoutNormalsOrUvs) {
    MeshPart part = wavy_part(2);
    EXPECT_EQ(make_tangents(part, TangentMethod::mikktspace, 1).error().code, ErrorCode::bad_option);
    EXPECT_EQ(make_tangents(part, TangentMethod::mikktspace, -1).error().code, ErrorCode::bad_option);
    part.normals.clear();
    EXPECT_EQ(make_tangents(part, TangentMethod::meshopt).error().code, ErrorCode::bad_option);
}

TEST(Tangents, CanBeCancelled) {
    const auto cancelled =
        make_tangents(wavy_part(50), TangentMethod::mikktspace, 0, {2, [](double) { return false; }});
    ASSERT_FALSE(cancelled);
    EXPECT_EQ(cancelled.error().code, ErrorCode::cancelled);
}

// A fan of triangles around one vertex, whose UVs turn: tangents point in all directions.
MeshPart turning_fan(int triangles) {
    MeshPart part;
    part.uvs.resize(1);
    part.positions = {{0, 0, 0}};
    part.normals = {{0, 0, 1}};
    part.uvs[0] = {{0, 0}};
    for (int k = 0; k < 2 * triangles; ++k) {
        const float turn = static_cast<float>(k) / static_cast<float>(2 * triangles) * 4.0f - 2.0f;
        const float x = 1.0f - std::abs(turn), y = std::abs(turn) <= 1.0f ? turn
                                                   : turn > 0             ? 2.0f - turn
                                                                          : -2.0f - turn;
        part.positions.push_back({x, y, 0});
        part.normals.push_back({0, 0, 1});
        part.uvs[0].push_back({1.0f, static_cast<float>(k % 2)});
    }
    for (int k = 0; k < triangles; ++k) {
        const auto a = static_cast<std::uint32_t>(2 * k + 1);
        const std::uint32_t b = 2 * k + 2 <= 2 * triangles - 1 ? a + 2 : 1;
        part.indices.insert(part.indices.end(), {0, a, b});
    }
    return part;
}

TEST(Tangents, RefuseTooManyTrianglesAroundAVertex) {
    const auto refused = make_tangents(turning_fan(kMaxFan + 1), TangentMethod::meshopt);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::unsupported);
    EXPECT_EQ(refused.error().reason, "4097 triangles meet at one vertex: at most 4096 are supported");
    EXPECT_TRUE(make_tangents(turning_fan(kMaxFan), TangentMethod::meshopt));
    // MikkTSpace compares pairs only if directions are opposite.
    EXPECT_TRUE(make_tangents(turning_fan(kMaxFan + 1), TangentMethod::mikktspace));
}

TEST(Tangents, AreFiniteForCoordinatesWhoseSquaresAreNot) {
    MeshPart part = wavy_part(4);
    for (Float3& p : part.positions) p = {p.x * 3e38f, p.y * 3e38f, p.z * 3e38f};
    for (const TangentMethod method : {TangentMethod::mikktspace, TangentMethod::meshopt}) {
        const auto tangents = make_tangents(part, method);
        ASSERT_TRUE(tangents);
        for (const Float4& t : *tangents) EXPECT_TRUE(std::isfinite(t.x + t.y + t.z));
    }
}

}  // namespace
}  // namespace tex
