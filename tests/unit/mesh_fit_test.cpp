// SPDX-License-Identifier: Apache-2.0
// Rule N711: whether a map fits its mesh.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tex/blend.h>
#include <tex/check.h>
#include <tex/mesh.h>
#include <tex/pack.h>

#include "mesh/coverage.h"
#include "unit/mesh_fits.h"

namespace tex {
namespace {

TEST(MeshFit, FindsWrongSpacesOnACube) {
    const SelectedPart selected = selected_cube();
    expect_verdicts(selected, {256, 256}, 1.0, "cube");
    const NormalMap surface = wavy_surface(selected.part, {256, 256}, 1.0);
    const Fit fit = fit_of(baked(surface, {selected.part, selected.tangents}), selected, Decoder::godot);
    EXPECT_TRUE(says(fit, "the decoder is one of unity-urp, unity-hdrp, unreal, gltf")) << message_of(fit);
}

// Godot takes z from x and y, whatever the file holds; other engines take the z that is there.
TEST(MeshFit, ReadsZAsTheDecoderDoes) {
    const SelectedPart selected = selected_cube();
    const NormalMap surface = wavy_surface(selected.part, {256, 256}, 1.0);
    Texture texture = baked(surface, {selected.part, selected.tangents, 0, Decoder::godot});
    const Fit right = fit_of(texture, selected, Decoder::godot);
    EXPECT_EQ(message_of(right), "");
    auto& bytes = texture.levels[0].bytes;
    for (std::size_t k = 2; k < bytes.size(); k += bytes.size() / (256 * 256)) bytes[k] = std::byte{140};
    const Fit same = fit_of(texture, selected, Decoder::godot);
    ASSERT_TRUE(right.seams && same.seams);
    EXPECT_EQ(message_of(same), "");
    EXPECT_NEAR(same.seams->mean, right.seams->mean, 0.2);
    const Fit other = fit_of(texture, selected, Decoder::unity_builtin);
    EXPECT_GT(other.seams->mean, 5.0 * right.seams->mean);
    EXPECT_TRUE(says(other, "the decoder is one of godot (")) << message_of(other);
}

// Short vectors keep their direction for engines that take the z that is there, but not for Godot.
TEST(MeshFit, NamesNoDecoderThatRebuildsZIfTheMapNeedsItsOwn) {
    const SelectedPart selected = selected_cube();
    const NormalMap surface = wavy_surface(selected.part, {256, 256}, 1.0);
    Texture texture = baked(surface, {selected.part, selected.tangents, 0, Decoder::substance_vertex});
    for (std::byte& byte : texture.levels[0].bytes)
        byte = static_cast<std::byte>(std::lround(127.5 + 0.6 * (std::to_integer<int>(byte) - 127.5)));
    EXPECT_EQ(message_of(fit_of(texture, selected, Decoder::substance_vertex)), "");
    const Fit fragment = fit_of(texture, selected, Decoder::gltf);
    EXPECT_TRUE(says(fragment, "the decoder is one of unity-builtin, substance-vertex (")) << message_of(fragment);
}

// The background is judged by what the mesh shows of it.
TEST(MeshFit, SaysHowMuchOfTheBackgroundIsOnTheMesh) {
    const SelectedPart selected = selected_cube();
    Texture texture = baked(wavy_surface(selected.part, {256, 256}, 1.0), {selected.part, selected.tangents});
    const auto coverage = CoverageMap::make(selected.part, 0, {256, 256}, 0);
    ASSERT_TRUE(coverage);
    const auto message_with = [&](int hole) {
        Texture holed = texture;
        auto& bytes = holed.levels[0].bytes;
        const std::size_t texel = bytes.size() / (256 * 256);
        std::vector<Covered> texels;
        for (int strip = 0; strip < coverage->strips(); ++strip) {
            coverage->cover(strip, texels);
            for (std::size_t k = 0; k < texels.size(); ++k) {
                const std::size_t at = 256 * static_cast<std::size_t>(strip * coverage->strip_rows()) + k;
                const std::size_t i = at % 256, j = at / 256;
                const auto inside = static_cast<std::size_t>(hole);
                if (texels[k].inside && (i >= inside || j >= inside)) continue;
                std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(at * texel), texel, std::byte{0});
            }
        }
        const MeshToCheck mesh{selected, Decoder::gltf, "mesh.glb"};
        CheckOptions options;
        options.mesh = &mesh;
        const auto report = check("map", holed, options);
        EXPECT_TRUE(report);
        for (const Finding& finding : report->findings) {
            if (finding.rule->id == "N215") return finding.message;
        }
        return std::string();
    };
    EXPECT_NE(message_with(0).find("; no chart of the mesh covers any of it"), std::string::npos) << message_with(0);
    EXPECT_NE(message_with(100).find("; charts of the mesh cover "), std::string::npos) << message_with(100);
}

// normalTexture.scale: what the material multiplies x and y by is a part of what the seams show.
TEST(MeshFit, SeamsCountTheScaleOfTheMaterial) {
    const SelectedPart selected = selected_cube();
    const NormalMap surface = wavy_surface(selected.part, {256, 256}, 1.0);
    // The mean for the map, flattened, in a material with this scale.
    const auto mean = [&](float flattened, double by) {
        auto map = to_tangent_space(surface, {selected.part, selected.tangents});
        EXPECT_TRUE(map);
        auto made = scale(std::move(map->map), flattened);
        EXPECT_TRUE(made);
        MipChain chain;
        chain.levels.push_back(std::move(*made));
        auto texture = pack(chain, {Encoding::float_});
        EXPECT_TRUE(texture);
        const MeshToCheck mesh{selected, Decoder::gltf, "mesh.glb", by};
        CheckOptions options;
        options.mesh = &mesh;
        const auto report = check("map", *texture, options);
        EXPECT_TRUE(report && report->seams);
        return report->seams->mean;
    };
    const double right = mean(1.0f, 1.0);
    EXPECT_NEAR(mean(0.25f, 4.0), right, 0.02);
    EXPECT_LT(mean(0.25f, 1.0), 0.7 * right);  // flatter, and so with smaller gaps
}

TEST(MeshFit, NamesTheTangentsThatTheMapWasMadeFor) {
    SelectedPart selected = selected_cube();
    const NormalMap surface = wavy_surface(selected.part, {256, 256}, 1.0);
    const Texture texture = baked(surface, {selected.part, selected.tangents});
    for (Float4& t : selected.tangents) {  // turned about the normal by up to 14 degrees
        const Float3 turned = unit_vector({t.x - 0.25f * t.y, t.y + 0.25f * t.x, t.z});
        t = {turned.x, turned.y, turned.z, t.w};
    }
    selected.source = TangentSource::file;
    const Fit fit = fit_of(texture, selected);
    EXPECT_TRUE(says(fit, "the tangents are those of mikktspace")) << message_of(fit);
}

TEST(MeshFit, FindsMapsInObjectSpace) {
    const SelectedPart selected = selected_cube();
    MipChain chain;
    chain.levels.push_back(wavy_surface(selected.part, {256, 256}, 1.0));
    const auto texture = pack(chain, {Encoding::rgb8, YAxis::up, Effort::fast});
    ASSERT_TRUE(texture);
    const MeshToCheck mesh{selected, Decoder::gltf, "mesh.glb"};
    CheckOptions options;
    options.mesh = &mesh;
    const auto report = check("map", *texture, options);
    ASSERT_TRUE(report);
    int found = 0;
    for (const Finding& finding : report->findings) {
        EXPECT_NE(finding.rule->id, "N213");
        found += finding.rule->id == "N721" ? 1 : 0;
    }
    EXPECT_EQ(found, 1);
}

TEST(MeshFit, MeasuresSeamsInDegrees) {
    const SelectedPart selected = selected_cube();
    const NormalMap surface = surface_map(smooth_cube(), {256, 256});
    const Fit right = fit_of(baked(surface, {selected.part, selected.tangents}), selected);
    ASSERT_TRUE(right.seams);
    EXPECT_EQ(right.seams->edges, 12);
    // The sides of the cube meet at right angles, and its map makes them flat.
    EXPECT_NEAR(right.seams->mean, 90.0, 2.0);
    EXPECT_NEAR(right.seams->worst, 90.0, 2.0);
}

SelectedPart selected_sheet() {
    SelectedPart selected;
    selected.part = wavy_part(4);
    selected.tangents = *make_tangents(selected.part);
    return selected;
}

Texture flat_on(const SelectedPart& selected) {
    NormalMap flat({64, 64});
    flat.x = Plane<float>({64, 64}, 0.0f);
    flat.y = Plane<float>({64, 64}, 0.0f);
    flat.z = Plane<float>({64, 64}, 1.0f);
    return baked(flat, {selected.part, selected.tangents});
}

TEST(MeshFit, SheetsWithoutSeamsHaveNoEvidence) {
    const SelectedPart selected = selected_sheet();
    const Fit fit = fit_of(flat_on(selected), selected);
    EXPECT_FALSE(fit.seams);
    EXPECT_FALSE(fit.finding);
}

TEST(MeshFit, GreenPointsAsDemandedElseAsTheFileStatesElseAsTheEngineReadsIt) {
    const SelectedPart selected = selected_sheet();
    const auto y_of = [&](Decoder decoder, std::optional<YAxis> demanded, std::optional<YAxis> stated) {
        const MeshToCheck mesh{selected, decoder};
        CheckOptions options;
        options.mesh = &mesh;
        options.require.y = demanded;
        Texture texture = flat_on(selected);
        texture.y_known = stated.has_value();
        texture.y_axis = stated.value_or(YAxis::up);
        const auto report = check("map", texture, options);
        return report ? report->y_on_mesh : std::nullopt;
    };
    EXPECT_EQ(y_of(Decoder::gltf, {}, {}), YAxis::up);
    EXPECT_EQ(y_of(Decoder::unreal, {}, {}), YAxis::down);
    EXPECT_EQ(y_of(Decoder::unreal, {}, YAxis::up), YAxis::up);
    EXPECT_EQ(y_of(Decoder::gltf, YAxis::down, YAxis::up), YAxis::down);
    EXPECT_FALSE(check("map", flat_on(selected))->y_on_mesh) << "no mesh";
}

}  // namespace
}  // namespace tex
