// SPDX-License-Identifier: Apache-2.0
// The rules of the family "mesh", except N711.

#include <tex/check.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tex/mesh.h>
#include <tex/pack.h>

#include "unit/meshes.h"
#include "unit/solids.h"

namespace tex {
namespace {

Texture flat_texture() {
    MipChain chain;
    chain.levels.emplace_back(Extent{64, 64});
    chain.levels[0].x = Plane<float>({64, 64}, 0.0f);
    chain.levels[0].y = Plane<float>({64, 64}, 0.0f);
    chain.levels[0].z = Plane<float>({64, 64}, 1.0f);
    auto texture = pack(chain, {Encoding::rgb8, YAxis::up, Effort::fast});
    EXPECT_TRUE(texture);
    return std::move(*texture);
}

// The findings of the family "mesh".
std::vector<Finding> findings_of(const SelectedPart& selected) {
    const MeshToCheck mesh{selected, Decoder::gltf, "sheet.glb"};
    CheckOptions options;
    options.mesh = &mesh;
    const auto report = check("map", flat_texture(), options);
    EXPECT_TRUE(report);
    std::vector<Finding> findings;
    for (const Finding& finding : report->findings) {
        if (finding.rule->family == RuleFamily::mesh) findings.push_back(finding);
    }
    return findings;
}

std::set<std::string> mesh_ids(const SelectedPart& selected) {
    std::set<std::string> ids;
    for (const Finding& finding : findings_of(selected)) ids.emplace(finding.rule->id);
    return ids;
}

using MeshIds = std::set<std::string>;

// A sheet whose file has stored MikkTSpace's tangents.
SelectedPart stored_sheet(TangentMethod method = TangentMethod::mikktspace) {
    SelectedPart selected;
    selected.part = wavy_part(8);
    for (Float2& uv : selected.part.uvs[0]) uv.y -= 0.125f * uv.x;
    selected.tangents = *make_tangents(selected.part, method);
    selected.source = TangentSource::file;
    selected.has_normal_map = selected.has_tangents = true;
    return selected;
}

TEST(CheckMesh, FindsNothingInTangentsOfMikktspace) { EXPECT_EQ(mesh_ids(stored_sheet()), MeshIds{}); }

TEST(CheckMesh, NotesMissingTangentsIfThereIsANormalMap) {
    SelectedPart selected = stored_sheet();
    selected.has_tangents = false;
    selected.source = TangentSource::mikktspace;
    EXPECT_EQ(mesh_ids(selected), MeshIds{"N701"});
    selected.has_normal_map = false;
    EXPECT_EQ(mesh_ids(selected), MeshIds{});
}

TEST(CheckMesh, CountsTangentsWithoutUnitLength) {
    SelectedPart selected = stored_sheet();
    selected.tangents[0] = {0.0f, 0.0f, 0.0f, 1.0f};
    for (std::size_t c = 3; c < 9; ++c) {
        Float4& t = selected.tangents[c];
        t = {1.25f * t.x, 1.25f * t.y, 1.25f * t.z, t.w};
    }
    const auto findings = findings_of(selected);
    ASSERT_EQ(findings.size(), 1u);
    EXPECT_EQ(findings[0].rule->id, "N702");
    EXPECT_DOUBLE_EQ(findings[0].figure, 7.0 / static_cast<double>(selected.tangents.size()));
    EXPECT_NE(findings[0].message.find("1 of 384 corners"), std::string::npos) << findings[0].message;
    EXPECT_NE(findings[0].message.find("0.000 to 1.250"), std::string::npos) << findings[0].message;
}

TEST(CheckMesh, FindsSignsThatAreNotOne) {
    SelectedPart selected = stored_sheet();
    selected.tangents[5].w = 0.0f;
    EXPECT_EQ(mesh_ids(selected), MeshIds{"N703"});
}

TEST(CheckMesh, FindsSignsThatChangeWithinATriangle) {
    SelectedPart selected = stored_sheet();
    selected.tangents[4].w *= -1.0f;
    const auto findings = findings_of(selected);
    ASSERT_EQ(findings.size(), 1u);
    EXPECT_EQ(findings[0].rule->id, "N704");
    EXPECT_DOUBLE_EQ(findings[0].figure, 1.0 / 128.0);
}

TEST(CheckMesh, FindsFlippedSigns) {
    SelectedPart selected = stored_sheet();
    for (Float4& t : selected.tangents) t.w = -t.w;
    EXPECT_EQ(mesh_ids(selected), MeshIds{"N706"});
    // w follows from the UVs whichever way v points.
    selected.part.v_axis = YAxis::down;
    EXPECT_EQ(mesh_ids(selected), MeshIds{"N722"});
}

TEST(CheckMesh, MeasuresTangentsAgainstMikktspaceAndNamesMeshopt) {
    SelectedPart selected = stored_sheet();
    // A fan of triangles of very different sizes, on which the methods disagree.
    for (std::size_t k = 0; k < selected.part.positions.size(); k += 3) selected.part.positions[k].z += 0.2f;
    selected.tangents = *make_tangents(selected.part, TangentMethod::meshopt);
    const auto uneven = findings_of(selected);
    ASSERT_EQ(uneven.size(), 1u);
    EXPECT_EQ(uneven[0].rule->id, "N705");
    EXPECT_EQ(uneven[0].severity, Severity::note);
    EXPECT_GT(uneven[0].figure, 5.0);
    EXPECT_NE(uneven[0].message.find("meshoptimizer's fit better: median 0.00, p99 0.00 degrees"), std::string::npos)
        << uneven[0].message;
    selected.tangents = *make_tangents(selected.part);
    EXPECT_EQ(mesh_ids(selected), MeshIds{});
}

// A hundredth of the corners may have any tangents.
TEST(CheckMesh, AFewOtherTangentsAreNoOtherMethod) {
    SelectedPart selected = stored_sheet();  // of 384 corners
    const auto turn = [&](std::size_t c) {
        const Float3 n = selected.part.normals[selected.part.indices[c]];
        const Float4 t = selected.tangents[c];
        const Float3 b = {n.y * t.z - n.z * t.y, n.z * t.x - n.x * t.z, n.x * t.y - n.y * t.x};
        selected.tangents[c] = {b.x, b.y, b.z, t.w};  // by 90 degrees
    };
    for (const std::size_t c : {7u, 100u, 383u}) turn(c);
    EXPECT_EQ(mesh_ids(selected), MeshIds{});
    for (std::size_t c = 0; c < 6; ++c) turn(c);
    EXPECT_EQ(mesh_ids(selected), MeshIds{"N705"});
}

// Engines light bumps from another side then (tests/engines/RESULTS.md).
TEST(CheckMesh, TangentsThatPointAsideAreAnError) {
    for (const double degrees : {50.0, 57.0, 63.0, 90.0, 180.0}) {
        SelectedPart selected = stored_sheet();
        const double radians = degrees * std::acos(-1.0) / 180.0;
        const auto along = static_cast<float>(std::cos(radians)), across = static_cast<float>(std::sin(radians));
        for (std::size_t c = 0; c < selected.tangents.size(); ++c) {
            const Float3 n = selected.part.normals[selected.part.indices[c]];
            const Float4 t = selected.tangents[c];
            const Float3 b = {n.y * t.z - n.z * t.y, n.z * t.x - n.x * t.z, n.x * t.y - n.y * t.x};
            selected.tangents[c] = {along * t.x + across * b.x, along * t.y + across * b.y, along * t.z + across * b.z,
                                    t.w};
        }
        const auto findings = findings_of(selected);
        ASSERT_EQ(findings.size(), 1u) << degrees;
        EXPECT_EQ(findings[0].rule->id, "N705") << degrees;
        EXPECT_EQ(findings[0].severity, degrees < 60.0 ? Severity::note : Severity::error) << degrees;
    }
}

// A triangle that is a line in the map has neither a tangent nor a side that MikkTSpace could know.
TEST(CheckMesh, TrianglesWithoutAreaInTheMapAreNotCompared) {
    SelectedPart selected = stored_sheet();
    const std::size_t corners = selected.tangents.size();
    for (std::uint32_t k = 0; k < 8; ++k) {
        for (const std::uint32_t v : {k, k + 1, k}) selected.part.indices.push_back(v);
        for (int c = 0; c < 3; ++c) selected.tangents.push_back({0.0f, 0.6f, 0.8f, -1.0f});
    }
    EXPECT_EQ(mesh_ids(selected), MeshIds{});
    for (std::size_t c = 0; c < corners; ++c) selected.tangents[c].w *= -1.0f;
    const auto findings = findings_of(selected);
    ASSERT_EQ(findings.size(), 1u);
    EXPECT_EQ(findings[0].rule->id, "N706");
    EXPECT_EQ(findings[0].figure, 1.0);
    EXPECT_NE(findings[0].message.find("128 of 128 triangles"), std::string::npos) << findings[0].message;
    EXPECT_EQ(findings[0].message.find("KHR_texture_transform"), std::string::npos) << findings[0].message;
    selected.has_transform = true;  // as a material does that mirrors its map
    EXPECT_NE(findings_of(selected)[0].message.find("KHR_texture_transform of the material makes"), std::string::npos);
}

TEST(CheckMesh, CountsMirroredTrianglesAndSharedTexels) {
    SelectedPart selected = stored_sheet();
    for (Float2& uv : selected.part.uvs[0]) uv.x = 1.0f - uv.x;
    selected.tangents = *make_tangents(selected.part);
    auto findings = findings_of(selected);
    ASSERT_EQ(findings.size(), 1u);
    EXPECT_EQ(findings[0].rule->id, "N722");
    EXPECT_DOUBLE_EQ(findings[0].figure, 1.0);

    selected = stored_sheet();
    const std::vector<std::uint32_t> once = selected.part.indices;
    selected.part.indices.insert(selected.part.indices.end(), once.begin(), once.end());
    selected.tangents = *make_tangents(selected.part);
    findings = findings_of(selected);
    ASSERT_EQ(findings.size(), 1u);
    EXPECT_EQ(findings[0].rule->id, "N723");
    EXPECT_DOUBLE_EQ(findings[0].figure, 64.0 * 64.0);
}

TEST(CheckMesh, FailsOnUvsThatAreTooFarAway) {
    SelectedPart selected = stored_sheet();
    for (Float2& uv : selected.part.uvs[0]) uv.x += 3e6f;
    const MeshToCheck mesh{selected, Decoder::gltf, "sheet.glb"};
    CheckOptions options;
    options.mesh = &mesh;
    const auto report = check("map", flat_texture(), options);
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, ErrorCode::unsupported);
    EXPECT_EQ(report.error().file, "sheet.glb");
}

TEST(CheckMesh, LooksOnlyAtTangentsOfTheFile) {
    SelectedPart selected = stored_sheet(TangentMethod::meshopt);
    selected.source = TangentSource::meshopt;
    for (Float4& t : selected.tangents) t.w = 0.5f;
    EXPECT_EQ(mesh_ids(selected), MeshIds{});
}

TEST(CheckMesh, CountsQuadsWhoseDiagonalMatters) {
    SelectedPart selected = stored_sheet();  // 8 by 8 quads, of which the file knows three
    selected.part.quads = {0, 2, 64};
    EXPECT_TRUE(check_part(selected.part));
    EXPECT_EQ(mesh_ids(selected), MeshIds{});                          // the sheet is bent evenly
    Float3& normal = selected.part.normals[selected.part.indices[3]];  // of the first quad alone
    normal = {normal.x + 0.8f, normal.y, normal.z};
    const auto findings = findings_of(selected);
    ASSERT_FALSE(findings.empty());
    const Finding& finding = findings.back();
    EXPECT_EQ(finding.rule->id, "N731");
    EXPECT_NE(finding.message.find(" of 3 quads"), std::string::npos) << finding.message;
    EXPECT_GT(finding.figure, 5.0);
    selected.part.quads = {0, 127};
    EXPECT_FALSE(check_part(selected.part));
    selected.part.quads = {2, 2};
    EXPECT_FALSE(check_part(selected.part));
}

}  // namespace
}  // namespace tex
