// SPDX-License-Identifier: Apache-2.0
// The failures that mesh.h promises, as in documented_failures_test.cpp.

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/tex.h>

#include "scratch.h"
#include "unit/failures.h"
#include "unit/normal_maps.h"

namespace tex {
namespace {

using namespace failures;

TEST(DocumentedFailures, OfMeshes) {
    const auto placed = [](auto change, std::array<double, 12> matrix) {
        MeshNode node;
        node.to_scene = matrix;
        return failure_of(in_scene(sheet(change), node));
    };
    const std::array<double, 12> same = MeshNode().to_scene;
    SelectedPart broken, whole;
    broken.part = sheet(kBroken);
    whole.part = sheet(kUnchanged);
    whole.tangents = kTangents;
    Model model;
    model.mesh.materials.emplace_back();
    Mesh mesh;
    mesh.parts.push_back(sheet(kUnchanged));
    ModelCheckOptions unknown;
    unknown.checks.enable = {"N999"};
    MeshReadOptions absent;
    absent.reader.reader = "/nowhere/tex-reader";
    const Scratch scratch;
    const std::string ply = scratch.write("a.ply", "ply\nformat ascii 1.0\nelement vertex 0\nend_header\n");
    ModelMap without;
    without.image = -1;
    expect_all({
        {"in_scene: check_part(part) fails", ErrorCode::bad_data, placed(kBroken, same)},
        {"in_scene: not invertible", ErrorCode::bad_data, placed(kUnchanged, {1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0})},
        {"in_scene: not finite", ErrorCode::bad_data, placed(kUnchanged, {1, 0, 0, NAN, 0, 1, 0, 0, 0, 0, 1, 0})},
        {"in_scene: coordinates", ErrorCode::bad_data, placed(kUnchanged, {1, 0, 0, 1e300, 0, 1, 0, 0, 0, 0, 1, 0})},
        {"in_tile: check_part fails", ErrorCode::bad_data, failure_of(in_tile(broken, 1001))},
        {"in_tile: below 1001", ErrorCode::bad_option, failure_of(in_tile(whole, 1000))},
        {"in_tile: no triangle is there", ErrorCode::bad_option, failure_of(in_tile(whole, 1002))},
        {"tiles_of: check_part fails", ErrorCode::bad_data, failure_of(tiles_of(broken))},
        {"stored_tangents: there are none", ErrorCode::bad_option, failure_of(stored_tangents(whole.part))},
        {"read_model: those of read_mesh()", ErrorCode::io, failure_of(read_model("none.gltf"))},
        {"read_map: no image", ErrorCode::bad_data, failure_of(read_map(model, without))},
        {"select_part", ErrorCode::cancelled, failure_of(select_part(mesh, {}, kStopped))},
        {"check_map: see validate()", ErrorCode::bad_option, failure_of(check_map(model, without, unknown))},
        {"read_mesh: the reader", ErrorCode::io, failure_of(read_mesh(ply, absent))},
        {"maps_of: no such material", ErrorCode::bad_option, failure_of(maps_of(model, "stone"))},
    });
}

TEST(DocumentedFailures, OfConversions) {
    const NormalMap map = flat_map({8, 8});
    const auto in_both = [&](const char* words, ErrorCode promised, auto change, const auto& tangents, int set) {
        const MeshPart part = sheet(change), good = sheet(kUnchanged);
        const TangentSpace space = {part, tangents, set}, sound = {good, kTangents};
        expect_all({{words, promised, failure_of(to_object_space(map, space))},
                    {words, promised, failure_of(to_tangent_space(map, space))},
                    {words, promised, failure_of(refit(map, space, sound))},
                    {words, promised, failure_of(refit(map, sound, space))}});
    };
    in_both("check_part(space.part) fails", ErrorCode::bad_data, kBroken, kTangents, 0);
    in_both("no normals", ErrorCode::bad_option, kWithoutNormals, kTangents, 0);
    in_both("no such set of UVs", ErrorCode::bad_option, kUnchanged, kTangents, 1);
    in_both("not as many tangents as corners", ErrorCode::bad_option, kUnchanged, kFewTangents, 0);
    in_both("no triangle covers a texel", ErrorCode::bad_option, kWithoutArea, kTangents, 0);
    in_both("UVs beyond a million", ErrorCode::unsupported, kFar, kTangents, 0);
    const auto wide = [](MeshPart& part) { part.uvs[0][1].x = part.uvs[0][2].x = 20.0f; };
    in_both("more than 16 repeats", ErrorCode::unsupported, wide, kTangents, 0);
    const MeshPart part = sheet(kUnchanged);
    const TangentSpace space = {part, kTangents};
    expect_all({{"no texels", ErrorCode::bad_option, failure_of(to_tangent_space(NormalMap(), space))},
                {"cancelled", ErrorCode::cancelled, failure_of(to_object_space(map, space, {}, kStopped))},
                {"cancelled", ErrorCode::cancelled, failure_of(to_tangent_space(map, space, {}, kStopped))},
                {"cancelled", ErrorCode::cancelled, failure_of(refit(map, space, space, {}, kStopped))}});
}

TEST(DocumentedFailures, OfTransfers) {
    const auto made = [](Extent extent, auto change, const auto& tangents, auto of_high, int set = 0) {
        const MeshPart low = sheet(change);
        return failure_of(transfer(extent, {low, tangents, set}, {sheet(of_high)}));
    };
    const auto with = [](auto change) {
        const MeshPart low = sheet(kUnchanged);
        TransferInputs inputs;
        change(inputs);
        return failure_of(transfer({8, 8}, {low, kTangents}, {sheet(kUnchanged)}, inputs));
    };
    const auto high = [](MeshPart& part) {
        for (Float3& position : part.positions) position.x += 100.0f;
    };
    MeshPart cage = sheet(kUnchanged);
    cage.indices.resize(3);
    const Plane<float> none, negative({2, 2}, -1.0f), endless({2, 2}, std::numeric_limits<float>::infinity());
    const MeshPart low = sheet(kUnchanged);
    const std::vector<MeshPart> nothing;
    const Extent side = {8, 8};
    expect_all({
        {"low: check_part()", ErrorCode::bad_data, made(side, kBroken, kTangents, kUnchanged)},
        {"high: check_part()", ErrorCode::bad_data, made(side, kUnchanged, kTangents, kBroken)},
        {"the extent is empty", ErrorCode::bad_option, made({0, 8}, kUnchanged, kTangents, kUnchanged)},
        {"the extent is too large", ErrorCode::bad_option,
         made({kMaxExtent + 1, 1}, kUnchanged, kTangents, kUnchanged)},
        {"no normals", ErrorCode::bad_option, made(side, kWithoutNormals, kTangents, kUnchanged)},
        {"no such set of UVs", ErrorCode::bad_option, made(side, kUnchanged, kTangents, kUnchanged, 1)},
        {"not as many tangents", ErrorCode::bad_option, made(side, kUnchanged, kFewTangents, kUnchanged)},
        {"no texel of the map", ErrorCode::bad_option, made(side, kWithoutArea, kTangents, kUnchanged)},
        {"no ray hits", ErrorCode::bad_option, made(side, kUnchanged, kTangents, high)},
        {"high is empty", ErrorCode::bad_option, failure_of(transfer(side, {low, kTangents}, nothing))},
        {"UVs", ErrorCode::unsupported, made(side, kFar, kTangents, kUnchanged)},
        {"nothing is wrong", std::nullopt, with([](auto&) {})},
        {"the cage", ErrorCode::bad_option, with([&](auto& inputs) { inputs.cage = &cage; })},
        {"a skew is empty", ErrorCode::bad_option, with([&](auto& inputs) { inputs.skew = &none; })},
        {"a skew is not finite", ErrorCode::bad_option, with([&](auto& inputs) { inputs.skew = &endless; })},
        {"an offset is negative", ErrorCode::bad_option, with([&](auto& inputs) { inputs.offset = &negative; })},
        {"groups", ErrorCode::bad_option, with([](auto& inputs) { inputs.low_groups = {1}; })},
        {"ids", ErrorCode::bad_option, with([](auto& inputs) {
             inputs.high_ids = {1, 2};
         })},
        {"details", ErrorCode::bad_option, with([](auto& inputs) { inputs.high_details.resize(2); })},
    });
}

}  // namespace
}  // namespace tex
