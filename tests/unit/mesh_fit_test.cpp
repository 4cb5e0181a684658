// SPDX-License-Identifier: Apache-2.0
// Rule N711: whether a map fits its mesh.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tex/blend.h>
#include <tex/check.h>
#include <tex/file.h>
#include <tex/mesh.h>
#include <tex/pack.h>

#include "mesh/coverage.h"
#include "unit/solids.h"

namespace tex {
namespace {

namespace fs = std::filesystem;

// A map in object space of a surface with waves, which depend on the position in space alone.
NormalMap wavy_surface(const MeshPart& part, Extent extent, double waves) {
    NormalMap map(extent);
    map.x = Plane<float>(extent, 0.0f);
    map.y = Plane<float>(extent, 0.0f);
    map.z = Plane<float>(extent, 1.0f);
    const auto coverage = CoverageMap::make(part, 0, extent, 2);
    EXPECT_TRUE(coverage);
    Float3 low = part.positions.front(), high = low;
    for (const Float3& p : part.positions) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const float size = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    const float k = static_cast<float>(6.28 * waves) / size;
    std::vector<Covered> texels;
    for (int strip = 0; strip < coverage->strips(); ++strip) {
        coverage->cover(strip, texels);
        for (std::size_t at = 0; at < texels.size(); ++at) {
            if (texels[at].triangle == kNoTriangle) continue;
            Float3 p, n;
            for (std::size_t c = 0; c < 3; ++c) {
                const std::uint32_t v = part.indices[3 * static_cast<std::size_t>(texels[at].triangle) + c];
                const auto w = static_cast<float>(texels[at].weights[c]);
                const Float3 &q = part.positions[v], &m = part.normals[v];
                p = {p.x + w * q.x, p.y + w * q.y, p.z + w * q.z};
                n = {n.x + w * m.x, n.y + w * m.y, n.z + w * m.z};
            }
            n = unit_vector({n.x + 0.4f * std::sin(k * (p.y + 0.5f * p.z)),
                             n.y + 0.4f * std::sin(k * (p.z + 0.5f * p.x)),
                             n.z + 0.4f * std::sin(k * (p.x + 0.5f * p.y))});
            const int i = static_cast<int>(at) % extent.width,
                      j = strip * coverage->strip_rows() + static_cast<int>(at) / extent.width;
            map.x.at(i, j) = n.x;
            map.y.at(i, j) = n.y;
            map.z.at(i, j) = n.z;
        }
    }
    return map;
}

// The map as a baker for this space makes it, in 8 bits.
Texture baked(const NormalMap& surface, const TangentSpace& space, YAxis y = YAxis::up) {
    auto map = to_tangent_space(surface, space);
    EXPECT_TRUE(map);
    MipChain chain;
    chain.levels.push_back(std::move(map->map));
    auto texture = pack(chain, {Encoding::rgb8, y, Effort::fast});
    EXPECT_TRUE(texture);
    texture->y_known = false;
    return std::move(*texture);
}

struct Fit {
    std::optional<Finding> finding;
    std::optional<SeamEvidence> seams;
};

Fit fit_of(const Texture& texture, const SelectedPart& selected, Decoder decoder = Decoder::gltf) {
    const MeshToCheck mesh{selected, decoder, "mesh.glb"};
    CheckOptions options;
    options.mesh = &mesh;
    const auto report = check("map", texture, options);
    EXPECT_TRUE(report);
    Fit fit;
    fit.seams = report->seams;
    for (const Finding& finding : report->findings) {
        EXPECT_NE(finding.rule->id, "N721");
        if (finding.rule->id == "N711") fit.finding = finding;
    }
    return fit;
}

std::string message_of(const Fit& fit) { return fit.finding ? fit.finding->message : ""; }

bool says(const Fit& fit, const std::string& words) { return message_of(fit).find(words) != std::string::npos; }

SelectedPart selected_cube() {
    SelectedPart selected;
    selected.part = smooth_cube().part;
    selected.tangents = *make_tangents(selected.part);
    selected.source = TangentSource::mikktspace;
    return selected;
}

// Finds every wrong space of a map on this mesh, and nothing in the right one.
void expect_verdicts(const SelectedPart& selected, Extent extent, double waves, const std::string& name) {
    const NormalMap surface = wavy_surface(selected.part, extent, waves);
    const std::vector<Float4>& own = selected.tangents;
    const Texture right = baked(surface, {selected.part, own});
    EXPECT_EQ(message_of(fit_of(right, selected)), "") << name;
    const Texture per_vertex = baked(surface, {selected.part, own, 0, Decoder::godot});
    const Fit fit = fit_of(per_vertex, selected);
    EXPECT_TRUE(says(fit, "the decoder is one of unity-builtin, godot, substance-vertex")) << name << message_of(fit);
    EXPECT_FALSE(says(fit, "green")) << name;
    EXPECT_EQ(message_of(fit_of(per_vertex, selected, Decoder::unity_builtin)), "") << name;
    const Texture down = baked(surface, {selected.part, own}, YAxis::down);
    EXPECT_TRUE(says(fit_of(down, selected), "green points down, or w")) << name;
    EXPECT_FALSE(says(fit_of(down, selected), "decoder")) << name;
    EXPECT_EQ(message_of(fit_of(down, selected, Decoder::unreal)), "") << name;  // which reads maps with y down
    std::vector<Float4> flipped = own;
    for (Float4& t : flipped) t.w = -t.w;
    EXPECT_TRUE(says(fit_of(baked(surface, {selected.part, flipped}), selected), "w of the tangents is flipped"))
        << name;
}

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

TEST(MeshFit, FindsWrongSpacesOnRealModels) {
    const fs::path folder = TEX_SOURCE_DIR "/../shared/data/mesh";
    if (!fs::exists(folder)) GTEST_SKIP() << "no shared data";
    const struct {
        const char *file, *material;
        int extent;
        double waves;
    } models[] = {{"Suzanne/02_suzanne.gltf", "", 1024, 6.0},
                  {"FlightHelmet/FlightHelmet.gltf", "RubberWoodMat", 2048, 3.0},
                  {"FlightHelmet/FlightHelmet.gltf", "MetalPartsMat", 2048, 3.0}};
    for (const auto& model : models) {
        const auto mesh = read_mesh(folder / model.file);
        ASSERT_TRUE(mesh);
        MeshSelection selection;
        selection.material = model.material;
        const auto selected = select_part(*mesh, selection);
        ASSERT_TRUE(selected);
        expect_verdicts(*selected, {model.extent, model.extent}, model.waves, std::string(model.file) + model.material);
    }
}

// What check-normals calls usual, and the table in its manual, which TEX_SEAMS=all in the environment prints; else a
// part of it is tested. Of HoseMat, few seams turn the map, so that green the other way shows little there.
TEST(MeshFit, MapsThatFitHaveAMeanUnderTheUsualOne) {
    const fs::path folder = TEX_SOURCE_DIR "/../shared/data/mesh";
    if (!fs::exists(folder)) GTEST_SKIP() << "no shared data";
    const bool all = std::getenv("TEX_SEAMS") != nullptr;
    const struct {
        const char *file, *material;
        bool always;
    } models[] = {{"Suzanne/02_suzanne.gltf", "", true},
                  {"FlightHelmet/FlightHelmet.gltf", "HoseMat", true},
                  {"FlightHelmet/FlightHelmet.gltf", "RubberWoodMat", false},
                  {"FlightHelmet/FlightHelmet.gltf", "GlassPlasticMat", false},
                  {"FlightHelmet/FlightHelmet.gltf", "MetalPartsMat", false},
                  {"FlightHelmet/FlightHelmet.gltf", "LeatherPartsMat", true},
                  {"FlightHelmet/FlightHelmet.gltf", "LensesMat", false}};
    for (const auto& [file, material, always] : models) {
        if (!always && !all) continue;
        const auto mesh = read_mesh(folder / file);
        ASSERT_TRUE(mesh);
        MeshSelection selection;
        selection.material = material;
        const auto selected = select_part(*mesh, selection);
        ASSERT_TRUE(selected);
        const struct {
            int side;
            double waves;
            Decoder decoder;
        } maps[] = {{512, 6.0, Decoder::gltf},   {1024, 6.0, Decoder::gltf},  {2048, 6.0, Decoder::gltf},
                    {512, 6.0, Decoder::godot},  {1024, 6.0, Decoder::godot}, {512, 2.0, Decoder::gltf},
                    {1024, 2.0, Decoder::three}, {2048, 2.0, Decoder::godot}};
        for (const auto& map : maps) {
            const int side = map.side;
            const double waves = map.waves;
            const Decoder decoder = map.decoder;
            if (!all && (side != 512 || waves != 6.0)) continue;
            const std::string where = std::string(file) + " " + material + " " + std::to_string(side) + " " +
                                      std::string(name_of(kDecoderNames, decoder)) + " " + std::to_string(waves);
            const NormalMap surface = wavy_surface(selected->part, {side, side}, waves);
            const auto seams_of = [&](YAxis y) {
                return fit_of(baked(surface, {selected->part, selected->tangents, 0, decoder}, y), *selected, decoder)
                    .seams;
            };
            const auto right = seams_of(YAxis::up), down = seams_of(YAxis::down);
            ASSERT_TRUE(right && down);
            EXPECT_LT(right->mean, right->usual) << where;
            EXPECT_GT(down->mean, std::string(material) == "HoseMat" ? right->mean : down->usual) << where;
            if (all)
                std::printf("%s: mean %.2f, usual %.1f, p99 %.2f; y down %.2f\n", where.c_str(), right->mean,
                            right->usual, right->p99, down->mean);
        }
    }
}

// normalTexture.scale: what the material multiplies x and y by is a part of what the seams show.
TEST(MeshFit, SeamsCountTheScaleOfTheMaterial) {
    const SelectedPart selected = selected_cube();
    const NormalMap surface = wavy_surface(selected.part, {256, 256}, 1.0);
    // Of the map, flattened, in a material with this scale.
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

TEST(MeshFit, FindsNothingInTheMapsOfRealModels) {
    const fs::path folder = TEX_SOURCE_DIR "/../shared/data/mesh";
    if (!fs::exists(folder)) GTEST_SKIP() << "no shared data";
    const auto expect_nothing = [&](const std::string& file, const std::string& material, const std::string& map) {
        const auto mesh = read_mesh(folder / file);
        const auto texture = read_texture(folder / map);
        ASSERT_TRUE(mesh && texture) << map;
        MeshSelection selection;
        selection.material = material;
        const auto selected = select_part(*mesh, selection);
        ASSERT_TRUE(selected) << map;
        const Fit fit = fit_of(*texture, *selected);
        EXPECT_EQ(message_of(fit), "") << map;
        ASSERT_TRUE(fit.seams) << map;
        EXPECT_GT(fit.seams->edges, 0) << map;
        EXPECT_LE(fit.seams->mean, fit.seams->p99) << map;
        EXPECT_LT(fit.seams->mean, fit.seams->usual) << map;
    };
    expect_nothing("Suzanne/02_suzanne.gltf", "", "Suzanne/02_suzanne_Normal.png");
    for (const std::string name : {"RubberWood", "GlassPlastic", "MetalParts", "LeatherParts", "Lenses"}) {
        expect_nothing("FlightHelmet/FlightHelmet.gltf", name + "Mat",
                       "FlightHelmet/FlightHelmet_Materials_" + name + "Mat_Normal.png");
    }
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
