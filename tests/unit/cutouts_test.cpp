// SPDX-License-Identifier: Apache-2.0
// Rays that pass where the high mesh has no alpha.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/mesh.h>

#include "unit/transfers.h"

namespace tex {
namespace {

// A square above the low one, whose normals lean to the right, and of which only the part from `left` is there.
MeshPart leaf_above(float height, float left) {
    MeshPart part = lifted(square(0.0f, 1.0f), height);
    for (std::size_t v = 0; v < part.positions.size(); ++v) {
        part.normals[v] = {0.6f, 0.0f, 0.8f};
        if (part.positions[v].x < left) part.positions[v].x = part.uvs[0][v].x = left;
    }
    return part;
}

// Alpha of 0 left of the middle, and of 1 right of it. Between both texels' centres it grows evenly.
Plane<float> half_alpha() {
    Plane<float> alpha(Extent{2, 1});
    alpha.at(0, 0) = 0.0f;
    alpha.at(1, 0) = 1.0f;
    return alpha;
}

}  // namespace

// A leaf with alpha is the same as one that is cut out, for rays and for those that look for occlusion.
TEST(Cutouts, AreWhatAMeshWithoutThemWouldBe) {
    const Plane<float> alpha = half_alpha();
    for (const HitChoice hit : {HitChoice::outermost, HitChoice::nearest}) {
        TransferOptions options = all_maps();
        options.occlusion = options.thickness = true;
        options.hit = hit;
        options.front = {Reach::Unit::absolute, 1.0};
        options.back = {Reach::Unit::absolute, 1.0};
        const MeshPart low = square(0.0f, 1.0f);
        std::vector<MeshPart> whole, cut;
        for (std::vector<MeshPart>* parts : {&whole, &cut}) {
            parts->push_back(leaf_above(0.25f, parts == &cut ? 0.5f : 0.0f));
            parts->push_back(lifted(square(0.0f, 1.0f), -0.5f));
        }
        TransferInputs inputs;
        inputs.high_details.resize(2);
        inputs.high_details[0].alpha = &alpha;
        const auto with = guided(low, whole, {64, 64}, inputs, options),
                   without = guided(low, cut, {64, 64}, {}, options);
        ASSERT_TRUE(with && without);
        EXPECT_EQ(with->missed, 0);
        double difference = 0.0;
        for_hits(*without, [&](int i, int j) {
            EXPECT_NEAR(with->map.x.at(i, j), without->map.x.at(i, j), 1e-6) << i << ' ' << j;
            EXPECT_NEAR(with->heights.at(i, j), without->heights.at(i, j), 1e-6) << i << ' ' << j;
            difference = std::max(
                difference, std::abs(static_cast<double>(with->occlusion.at(i, j) - without->occlusion.at(i, j))));
        });
        EXPECT_LT(difference, 0.04) << "two of 64 rays that meet the border of the leaf";
        EXPECT_NEAR(with->heights.at(8, 8), -0.5f, 1e-6);
        EXPECT_NEAR(with->map.x.at(60, 8), 0.6f, 1e-5);
    }
}

// Leaves over leaves: rays pass the first 64, and no more.
TEST(Cutouts, AreLimitedInNumber) {
    Plane<float> none(Extent{1, 1});
    none.at(0, 0) = 0.0f;
    for (const int leaves : {3, 64, 70}) {
        std::vector<MeshPart> parts;
        for (int k = 0; k < leaves; ++k) parts.push_back(leaf_above(0.5f - 0.005f * static_cast<float>(k), 0.0f));
        parts.push_back(lifted(square(0.0f, 1.0f), -0.25f));
        TransferInputs inputs;
        inputs.high_details.resize(parts.size());
        for (int k = 0; k < leaves; ++k) inputs.high_details[static_cast<std::size_t>(k)].alpha = &none;
        TransferOptions options = all_maps();
        options.front = options.back = {Reach::Unit::absolute, 1.0};
        const auto maps = guided(square(0.0f, 1.0f), parts, {8, 8}, inputs, options);
        ASSERT_TRUE(maps);
        EXPECT_NEAR(maps->heights.at(4, 4), leaves <= 64 ? -0.25f : 0.5f - 0.005f * 64.0f, 1e-5) << leaves;
    }
}

TEST(Cutouts, OfNoTexelsOrUvsAreRefused) {
    const std::vector<MeshPart> parts = only(square(0.0f, 1.0f));
    const Plane<float> empty, alpha = half_alpha();
    TransferInputs inputs;
    inputs.high_details.resize(1);
    const auto refused = [&](const std::string& why) {
        const auto maps = guided(square(0.0f, 1.0f), parts, {8, 8}, inputs);
        ASSERT_FALSE(maps);
        EXPECT_EQ(maps.error().code, ErrorCode::bad_option);
        EXPECT_NE(maps.error().reason.find(why), std::string::npos) << maps.error().reason;
    };
    inputs.high_details[0].alpha = &empty;
    refused("part 0: has alpha without texels");
    inputs.high_details[0].alpha = &alpha;
    inputs.high_details[0].alpha_uv_set = 1;
    refused("part 0: has no such set of UVs");
    inputs.high_details[0].alpha_uv_set = 0;
    inputs.high_details[0].alpha_cutoff = std::nanf("");
    refused("part 0: alpha_cutoff must be finite");
}

}  // namespace tex
