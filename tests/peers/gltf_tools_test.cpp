// SPDX-License-Identifier: Apache-2.0
// Models that gltfpack and gltf-transform compress: libtex reads the triangles that they were made from.
//
// The tools come from npm, into a folder of the build; the test is skipped where npm or its registry is missing. Each
// output is read, its normal map's parts are selected, and the map is decoded on both meshes. The angles between the
// results are those that quantisation explains, and check-normals finds in it what it finds in the model. With
// TEX_GLTF_TOOLS=all in the environment, every model goes through every tool; else a third of the pairs, which show the
// same.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tex/tex.h>

#include "npm.h"
#include "scratch.h"

namespace {

namespace fs = std::filesystem;

const fs::path kMeshes = fs::path(TEX_SOURCE_DIR) / "../shared/data/mesh";

bool run(const std::string& command) { return std::system((command + " >/dev/null 2>&1 </dev/null").c_str()) == 0; }

// The folder of the tools' programs; empty if they cannot be installed.
std::string tools() {
    static const std::string folder = tex::npm_folder("gltf-tools", "gltfpack@1.3.0 @gltf-transform/cli@4.5.1");
    return folder.empty() ? folder : folder + "/node_modules/.bin/";
}

struct Sample {
    const char* name;
    const char* file;
    const char* material;  // or empty
    bool exact_only;       // without a texture, gltfpack keeps no scale of its quantised UVs
    bool always;
};

constexpr Sample kSamples[] = {
    {"Plane", "AssetGenerator_plane/Mesh_PrimitiveAttribute_06.gltf", "", false, false},
    {"PlaneWithoutTangents", "AssetGenerator_plane/Mesh_PrimitiveAttribute_05.gltf", "", false, false},
    {"Suzanne", "Suzanne/02_suzanne.gltf", "", false, true},
    {"Helmet", "FlightHelmet/FlightHelmet.gltf", "GlassPlasticMat", false, true},  // no texels are shared
    {"NormalTangentTest", "NormalTangentTest.glb", "", false, true},
    {"Cube", "mikktspace_obj/cube_wasm.glb", "", true, true},
};

struct Tool {
    const char* name;
    const char* program;
    const char* before;  // arguments before the names
    const char* after;
    double mean, p98;  // degrees
    bool exact;        // nothing is quantised
};

constexpr Tool kTools[] = {
    {"GltfpackDefault", "gltfpack", "-kn -km -i", "", 0.5, 3.0, false},
    {"GltfpackC", "gltfpack", "-kn -km -c -i", "", 0.5, 3.0, false},
    {"GltfpackCc", "gltfpack", "-kn -km -cc -i", "", 0.6, 3.0, false},
    {"GltfpackKhr", "gltfpack", "-kn -km -cz -ce khr -i", "", 0.6, 3.0, false},
    {"GltfpackNoQuantization", "gltfpack", "-kn -km -kv -noq -i", "", 1e-3, 1e-3, true},
    {"Draco", "gltf-transform", "draco", "", 0.6, 3.0, false},
    {"Meshopt", "gltf-transform", "meshopt", "", 0.6, 3.0, false},
    {"Quantize", "gltf-transform", "quantize", "", 0.6, 3.0, false},
    {"Dedup", "gltf-transform", "dedup", "", 1e-3, 1e-3, true},
    {"Webp", "gltf-transform", "webp", "", 1e-3, 1e-3, true},
};

bool runs_all() {
    const char* const wish = std::getenv("TEX_GLTF_TOOLS");
    return wish != nullptr && std::string(wish) == "all";
}

tex::NormalMap waves() {
    tex::HeightField field;
    field.height = tex::Plane<float>({256, 256});
    for (int j = 0; j < 256; ++j) {
        for (int i = 0; i < 256; ++i) {
            const double u = 6.283185307 * i / 256.0, v = 6.283185307 * j / 256.0;
            field.height.at(i, j) = static_cast<float>(std::sin(3.0 * u) * std::cos(2.0 * v));
        }
    }
    field.bumpiness_x = field.bumpiness_y = 10.0f;
    auto normals = tex::bake(field);
    EXPECT_TRUE(normals);
    return std::move(*normals);
}

struct OnMesh {
    tex::NormalMap map;
    std::int64_t covered = 0;
    tex::TangentSource source = tex::TangentSource::file;
};

// The map in the space of the scene, without padding. Only triangles that cover a texel alone can be compared.
std::optional<OnMesh> on_mesh(const fs::path& file, const std::string& material) {
    const auto mesh = tex::read_mesh(file.string());
    EXPECT_TRUE(mesh) << mesh.error().message();
    if (!mesh) return std::nullopt;
    tex::MeshSelection selection;
    selection.material = material;
    selection.in_scene = true;
    const auto selected = tex::select_part(*mesh, selection);
    EXPECT_TRUE(selected) << selected.error().message();
    if (!selected) return std::nullopt;
    EXPECT_TRUE(selected->remarks.empty());
    tex::ConvertOptions with;
    with.padding = 0;
    auto object = tex::to_object_space(waves(), {selected->part, selected->tangents, 0, tex::Decoder::gltf}, with);
    EXPECT_TRUE(object) << object.error().message();
    if (!object) return std::nullopt;
    return OnMesh{std::move(object->map), object->covered, selected->source};
}

// Degrees between the vectors of texels that both cover, in ascending order.
std::vector<double> angles(const tex::NormalMap& a, const tex::NormalMap& b) {
    const auto is_flat = [](const tex::NormalMap& m, int i, int j) {
        return m.x.at(i, j) == 0.0f && m.y.at(i, j) == 0.0f;
    };
    std::vector<double> all;
    for (int j = 0; j < a.extent().height; ++j) {
        for (int i = 0; i < a.extent().width; ++i) {
            if (is_flat(a, i, j) || is_flat(b, i, j)) continue;
            const double d[3] = {double{a.x.at(i, j)} - double{b.x.at(i, j)},
                                 double{a.y.at(i, j)} - double{b.y.at(i, j)},
                                 double{a.z.at(i, j)} - double{b.z.at(i, j)}};
            const double chord = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
            all.push_back(2.0 * std::asin(std::min(1.0, chord / 2.0)) * 180.0 / 3.14159265358979);
        }
    }
    std::sort(all.begin(), all.end());
    return all;
}

// The findings of a model: the material and the rule of each. Rules about images alone are left out of models whose
// images were encoded again.
std::set<std::pair<std::string, std::string>> findings_of(const fs::path& file, bool same_images) {
    std::set<std::pair<std::string, std::string>> found;
    const auto model = tex::read_model(file.string());
    EXPECT_TRUE(model) << model.error().message();
    if (!model) return found;
    for (const tex::ModelMap& map : model->maps) {
        const auto report = tex::check_map(*model, map);
        EXPECT_TRUE(report) << report.error().message();
        if (!report) continue;
        for (const tex::Finding& finding : report->findings) {
            const bool of_mesh =
                finding.rule->family == tex::RuleFamily::mesh || finding.rule->family == tex::RuleFamily::model;
            if (!same_images && (!of_mesh || finding.rule->id == "N724")) continue;  // N724 looks at the padding
            found.emplace(model->mesh.materials[static_cast<std::size_t>(map.material)].name, finding.rule->id);
        }
    }
    return found;
}

// gltf-transform refuses a model of which a picture is missing, and only the normal maps are in ../shared/data.
void add_missing_pictures(const fs::path& model, const fs::path& picture) {
    std::ifstream file(model);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    for (std::size_t at = text.find("\"uri\""); at != std::string::npos; at = text.find("\"uri\"", at + 1)) {
        const std::size_t from = text.find('"', at + 5) + 1;
        const fs::path name = model.parent_path() / text.substr(from, text.find('"', from) - from);
        if (name.extension() == ".png" && !fs::exists(name)) fs::copy_file(picture, name);
    }
}

class GltfTools : public testing::TestWithParam<Sample> {
protected:
    void SetUp() override {
        if (!fs::exists(kMeshes)) GTEST_SKIP() << "no ../shared/data";
        if (!GetParam().always && !runs_all()) return;
        if (tools().empty()) GTEST_SKIP() << "npm cannot install gltfpack and gltf-transform here";
        fs::copy((kMeshes / GetParam().file).parent_path(), scratch_.path("in"), fs::copy_options::recursive);
        for (const auto& entry : fs::recursive_directory_iterator(scratch_.path()))
            fs::permissions(entry, fs::perms::owner_all, fs::perm_options::add);
        model_ = fs::path(scratch_.path("in")) / fs::path(GetParam().file).filename();
        if (model_.extension() == ".gltf")
            add_missing_pictures(model_, fs::path(TEX_SOURCE_DIR) / "samples/bricks.png");
    }

    const tex::Scratch scratch_;
    fs::path model_;
};

TEST_P(GltfTools, OutputsAreReadAsTheModel) {
    if (!GetParam().always && !runs_all()) return;
    const auto plain = on_mesh(model_, GetParam().material);
    ASSERT_TRUE(plain);
    for (const Tool& tool : kTools) {
        SCOPED_TRACE(tool.name);
        if (GetParam().exact_only && !tool.exact) continue;
        if (!runs_all() && !GetParam().exact_only && (tool.exact || std::string(tool.name) == "Quantize")) continue;
        const std::string out = scratch_.path(std::string(tool.name) + ".glb");
        const bool is_gltfpack = std::string(tool.program) == "gltfpack";
        ASSERT_TRUE(run("cd '" + scratch_.path() + "' && '" + tools() + tool.program + "' " + tool.before + " '" +
                        model_.string() + (is_gltfpack ? "' -o '" : "' '") + out + "'" + tool.after));
        const auto packed = on_mesh(out, GetParam().material);
        ASSERT_TRUE(packed);
        EXPECT_EQ(packed->source, plain->source);
        EXPECT_NEAR(static_cast<double>(packed->covered), static_cast<double>(plain->covered),
                    tool.exact ? 0.0 : 0.02 * static_cast<double>(plain->covered));
        const bool same_images = std::string(tool.name) != "Webp";
        auto found = findings_of(out, same_images);
        const auto wanted = findings_of(model_, same_images);
        // Tangents of 8 bits differ from MikkTSpace's by up to 2 degrees more, which N705 may say.
        if (!tool.exact) std::erase_if(found, [&](const auto& f) { return f.second == "N705" && !wanted.contains(f); });
        EXPECT_EQ(found, wanted);
        const std::vector<double> all = angles(plain->map, packed->map);
        ASSERT_GT(all.size(), 1000u);
        double sum = 0.0;
        for (const double angle : all) sum += angle;
        EXPECT_LE(sum / static_cast<double>(all.size()), tool.mean);
        EXPECT_LE(all[all.size() * 98 / 100], tool.p98);
        std::printf("%-18s %-24s mean %.4f, p98 %.3f degrees of %zu texels\n", GetParam().name, tool.name,
                    sum / static_cast<double>(all.size()), all[all.size() * 98 / 100], all.size());
    }
}

INSTANTIATE_TEST_SUITE_P(Models, GltfTools, testing::ValuesIn(kSamples),
                         [](const auto& row) { return std::string(row.param.name); });

}  // namespace
