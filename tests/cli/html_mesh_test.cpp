// SPDX-License-Identifier: Apache-2.0
// The mesh of a page: its vertices and triangles as bytes, and how many meshes a page holds.

#include "reports/html_mesh.h"

#include <bit>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "reports/html_report.h"

namespace tex::cli {
namespace {

// A square of two triangles in the plane z = 5, 2 wide and 4 high, with UVs over the whole map.
MeshPart square() {
    MeshPart part;
    part.positions = {{1, 1, 5}, {3, 1, 5}, {3, 5, 5}, {1, 5, 5}};
    part.normals.assign(4, {0, 0, 2});
    part.uvs = {{{0, 0.25f}, {1, 0.25f}, {1, 1}, {0, 1}}};
    part.indices = {0, 1, 2, 0, 2, 3};
    return part;
}

template <class T>
T value_at(const HtmlMesh& mesh, std::size_t byte) {
    T value{};
    std::memcpy(&value, mesh.bytes.data() + byte, sizeof value);
    return value;
}

TEST(HtmlMesh, HasEachVertexOnceInTheUnitSphere) {
    const MeshPart part = square();
    const std::vector<Float4> tangents(6, {3, 0, 0, -1});
    const auto mesh = html_mesh({part, tangents, 0, Decoder::godot}, "--mesh square.obj");
    ASSERT_TRUE(mesh);
    EXPECT_EQ(mesh->vertices, 4u);
    EXPECT_EQ(mesh->triangles, 2u);
    ASSERT_EQ(mesh->bytes.size(), 4 * kHtmlVertexSize + 6 * 2);
    // The corner (3, 1, 5) is (1, -2, 0) from the centre, and sqrt(5) away.
    const std::int16_t expected[] = {14654, -29308, 0, 0, 0, 32767, 32767, 0, 0, -32767};
    for (std::size_t k = 0; k < 10; ++k)
        EXPECT_EQ(value_at<std::int16_t>(*mesh, kHtmlVertexSize + 2 * k), expected[k]) << k;
    EXPECT_EQ(value_at<float>(*mesh, kHtmlVertexSize + 20), 1.0f);
    EXPECT_EQ(value_at<float>(*mesh, kHtmlVertexSize + 24), 0.75f) << "v down";
    const std::uint16_t indices[] = {0, 1, 2, 0, 2, 3};
    for (std::size_t k = 0; k < 6; ++k)
        EXPECT_EQ(value_at<std::uint16_t>(*mesh, 4 * kHtmlVertexSize + 2 * k), indices[k]);
    EXPECT_EQ(mesh->json()["decoder"], "godot");
    EXPECT_EQ(mesh->json()["arguments"], "--mesh square.obj");
}

TEST(HtmlMesh, CornersWithOtherTangentsAreOtherVertices) {
    const MeshPart part = square();
    std::vector<Float4> tangents(6, {1, 0, 0, 1});
    tangents[3].w = -1.0f;
    EXPECT_EQ(html_mesh({part, tangents}, {})->vertices, 5u);
    tangents[3] = {0, 0, 0, 1};
    const auto mesh = html_mesh({part, tangents}, {});
    EXPECT_EQ(value_at<std::int16_t>(*mesh, 3 * kHtmlVertexSize + 12), 0) << "null stays null";
}

TEST(HtmlMesh, ManyVerticesTakeLongIndicesAndTooManyAreLeftOut) {
    MeshPart part;
    part.uvs.resize(1);
    const auto grow = [&](std::uint32_t triangles) {
        for (auto t = static_cast<std::uint32_t>(part.triangles()); t < triangles; ++t) {
            for (std::uint32_t k = 0; k < 3; ++k) {
                part.positions.push_back({static_cast<float>(t), static_cast<float>(k % 2), static_cast<float>(k / 2)});
                part.normals.push_back({0, 0, 1});
                part.uvs[0].push_back({static_cast<float>(k), static_cast<float>(t)});
                part.indices.push_back(3 * t + k);
            }
        }
        const std::vector<Float4> tangents(part.indices.size(), {1, 0, 0, 1});
        return html_mesh({part, tangents}, {});
    };
    EXPECT_EQ(grow(21'845)->bytes.size(), 65'535 * (kHtmlVertexSize + 2));
    EXPECT_EQ(grow(21'846)->bytes.size(), 65'538 * (kHtmlVertexSize + 4));
    EXPECT_EQ(grow(70'000), nullptr);
    MeshPart dense = square();
    dense.indices.resize(3'000'003);
    const std::vector<Float4> tangents(dense.indices.size(), {1, 0, 0, 1});
    EXPECT_EQ(html_mesh({dense, tangents}, {}), nullptr);
}

// An entry whose map is on a mesh of `size` bytes; null: a mesh that is too large.
HtmlEntry entry_on(const std::string& name, std::size_t size, int shade) {
    HtmlEntry entry;
    entry.title = name;
    HtmlMap map;
    map.file = name;
    map.extent = {4, 4};
    map.decoded.levels.push_back({{4, 4}, std::vector<std::byte>(48)});
    map.on_mesh.emplace();
    map.on_mesh->triangles = 1'234'567;
    if (size > 0) {
        auto mesh = std::make_shared<HtmlMesh>();
        mesh->bytes.assign(size, static_cast<std::byte>(shade));
        map.on_mesh->mesh = mesh;
    }
    entry.maps.push_back(std::move(map));
    return entry;
}

int count(const std::string& page, const std::string& text) {
    int found = 0;
    for (std::size_t at = page.find(text); at != std::string::npos; at = page.find(text, at + 1)) ++found;
    return found;
}

TEST(HtmlMesh, IsInThePageOnceForAllOfItsMaps) {
    HtmlReport report("check-normals", {});
    for (const char* name : {"a.png", "b.png", "c.png"}) report.add(name, entry_on(name, 1000, name[0] == 'c' ? 2 : 1));
    const std::string page = report.page("");
    EXPECT_EQ(count(page, "id=\"mesh-"), 2);
    EXPECT_EQ(count(page, "data-mesh=\"0\""), 2);
    EXPECT_EQ(count(page, "data-mesh=\"1\""), 1);
}

TEST(HtmlMesh, PagesStayBoundedWhateverTheOrder) {
    const auto page = [](std::vector<std::string> names) {
        HtmlReport report("check-normals", {});
        for (const std::string& name : names)
            report.add(name, entry_on(name, name == "0" ? 0 : 2'000'000, std::stoi(name)));
        return report.page("");
    };
    const std::string one = page({"0", "1", "2", "3", "4"});
    EXPECT_EQ(count(one, "id=\"mesh-"), 2) << "2.7 MB each";
    EXPECT_LT(one.size(), kHtmlMeshBudget);
    EXPECT_EQ(count(one, "because its 1234567 triangles would make this report too large."), 1);
    EXPECT_EQ(count(one, "because the meshes before it fill the space that this report has for meshes."), 2);
    EXPECT_TRUE(one == page({"4", "2", "3", "1", "0"}));
}

}  // namespace
}  // namespace tex::cli
