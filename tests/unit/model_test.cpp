// SPDX-License-Identifier: Apache-2.0

#include <tex/mesh.h>

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/check.h>
#include <tex/file.h>
#include <tex/pack.h>
#include <tex/pipeline.h>

#include "scratch.h"
#include "unit/gltf_files.h"

namespace tex {
namespace {

namespace fs = std::filesystem;

// A picture of one colour.
std::vector<std::byte> picture(Extent extent, Container container = Container::png) {
    NormalMap map(extent);
    map.x = Plane<float>(extent, 0.0f);
    map.y = Plane<float>(extent, 0.0f);
    map.z = Plane<float>(extent, 1.0f);
    MipChain chain;
    chain.levels.push_back(std::move(map));
    const auto texture = pack(chain, {Encoding::rgb8});
    EXPECT_TRUE(texture);
    auto bytes = encode_file(*texture, container);
    EXPECT_TRUE(bytes);
    return std::move(*bytes);
}

std::string base64(const std::vector<std::byte>& bytes) {
    static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t k = 0; k < bytes.size(); k += 3) {
        unsigned group = 0;
        for (std::size_t b = 0; b < 3; ++b)
            group = group << 8 | (k + b < bytes.size() ? std::to_integer<unsigned>(bytes[k + b]) : 0);
        for (unsigned d = 0; d < 4; ++d) text += k + d > bytes.size() ? '=' : kDigits[group >> (18 - 6 * d) & 63];
    }
    return text;
}

class Models : public testing::Test, protected Scratch {
protected:
    Models() {
        maker_.add(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3", 5126);
        maker_.add(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, "SCALAR", 5123);
        maker_.add(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 5126);
        maker_.add(std::vector<float>{0, 1, 1, 1, 1, 0, 0, 0}, "VEC2", 5126);
    }

    // A model of one square with these materials, textures and images.
    Result<Model> read(const std::string& rest, const std::string& material = "0") {
        const std::string primitive =
            R"({"attributes":{"POSITION":0,"NORMAL":2,"TEXCOORD_0":3},"indices":1,"material":)" + material + "}";
        return read_model(write("m.glb", maker_.glb(primitive, "," + rest)));
    }

    GltfMaker maker_;
};

TEST_F(Models, ImagesAreInViewsDataUrisAndFiles) {
    write("maps/a b.png", picture({8, 4}));
    const int view = maker_.add_view(picture({16, 4}));
    const auto model =
        read(R"("materials":[{"name":"leather","normalTexture":{"index":0,"scale":0.5}},)"
             R"({"normalTexture":{"index":1},"extensions":{"KHR_materials_clearcoat":)"
             R"({"clearcoatNormalTexture":{"index":2}}}}],)"
             R"("textures":[{"source":0},{"source":1},{"source":2}],"images":[{"uri":"maps/a%20b.png"},)"
             R"({"name":"inside","mimeType":"image/png","bufferView":)" +
             std::to_string(view) + R"(},{"uri":"data:image/png;base64,)" + base64(picture({32, 4})) + "\"}]");
    ASSERT_TRUE(model) << model.error().message();
    ASSERT_EQ(model->maps.size(), 3u);
    EXPECT_EQ(model->maps[0].scale, 0.5);
    EXPECT_EQ(model->maps[2].slot, NormalSlot::clearcoat_normal);
    EXPECT_EQ(map_name(*model, model->maps[0]), "leather: a b.png");
    EXPECT_EQ(map_name(*model, model->maps[1]), "1: inside");
    EXPECT_EQ(map_name(*model, model->maps[2]), "1 (clearcoat): image 2");
    const int widths[] = {8, 16, 32};
    for (std::size_t k = 0; k < 3; ++k) {
        const auto texture = read_map(*model, model->maps[k]);
        ASSERT_TRUE(texture) << texture.error().message();
        EXPECT_EQ(texture->extent().width, widths[k]);
    }
    const auto of_second = maps_of(*model, "1");
    ASSERT_TRUE(of_second);
    EXPECT_EQ(of_second->size(), 2u);
    EXPECT_EQ(maps_of(*model, "leather")->size(), 1u);
    EXPECT_EQ(maps_of(*model, "paint").error().code, ErrorCode::bad_option);
    // Without geometry, the same maps and images.
    const auto maps = read_model_maps(model->file);
    ASSERT_TRUE(maps) << maps.error().message();
    EXPECT_TRUE(maps->mesh.parts.empty());
    ASSERT_EQ(maps->maps.size(), 3u);
    ASSERT_EQ(maps->mesh.materials.size(), 2u);
    EXPECT_EQ(maps->images[1].bytes, model->images[1].bytes);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(map_name(*maps, maps->maps[k]), map_name(*model, model->maps[k]));
}

TEST_F(Models, MapsAreReadWithoutTheGeometryTheyAreOn) {
    std::ofstream(path("bad.gltf")) << R"({"asset":{"version":"2.0"},"meshes":[{"primitives":[{"attributes":
        {"POSITION":7}}]}],"materials":[{"normalTexture":{"index":0}}],"textures":[{"source":0}],
        "images":[{"uri":"n.png"}]})";
    EXPECT_FALSE(read_model(path("bad.gltf")));
    const auto maps = read_model_maps(path("bad.gltf"));
    ASSERT_TRUE(maps) << maps.error().message();
    EXPECT_EQ(maps->maps.size(), 1u);
    EXPECT_EQ(read_model_maps(path("missing.glb")).error().code, ErrorCode::io);
    std::ofstream(path("new.gltf")) << R"({"asset":{"version":"2.0"},"extensionsRequired":["ACME_uvs"]})";
    EXPECT_EQ(read_model_maps(path("new.gltf")).error().code, ErrorCode::unsupported);
}

TEST_F(Models, BytesInMemoryAreReadAsAFile) {
    ReadOptions options;
    options.bytes = std::make_shared<const std::vector<std::byte>>(picture({16, 4}));
    const auto texture = read_texture("no such file", options);
    ASSERT_TRUE(texture) << texture.error().message();
    EXPECT_EQ(texture->extent().width, 16);
    const auto image = read_image("no such file", options);
    ASSERT_TRUE(image);
    EXPECT_EQ(image->planes.size(), 3u);
    SourceOptions source;
    source.read = options;
    const auto normals = read_normals("no such file", source);
    ASSERT_TRUE(normals);
    EXPECT_EQ(normals->chain.levels.front().extent().height, 4);
    PackFileOptions with;
    with.source = source;
    const std::string output = path("x.dds");
    ASSERT_TRUE(pack_file("no such file", output, Container::dds, with));
    EXPECT_EQ(read_texture(output)->extent().width, 16);
    options.bytes = std::make_shared<const std::vector<std::byte>>(4, std::byte{'x'});
    const auto bad = read_texture("inside", options);
    ASSERT_FALSE(bad);
    EXPECT_EQ(bad.error().file, "inside");
}

TEST_F(Models, ExtensionsOfTexturesAndUsesAreKnown) {
    const int dds = maker_.add_view(picture({8, 8}, Container::dds));
    const auto model =
        read(R"("materials":[{"normalTexture":{"index":0},"pbrMetallicRoughness":{"baseColorTexture":{"index":0},)"
             R"("metallicRoughnessTexture":{"index":1}}}],"textures":[{"source":1,"extensions":{"MSFT_texture_dds":)"
             R"({"source":0}}},{"source":1}],"images":[{"bufferView":)" +
             std::to_string(dds) + R"(},{"uri":"b.png"}])");
    ASSERT_TRUE(model) << model.error().message();
    ASSERT_EQ(model->maps.size(), 1u);
    EXPECT_EQ(model->maps[0].image, 0);
    ASSERT_EQ(model->images[0].uses.size(), 2u);
    const auto color = std::count_if(model->images[0].uses.begin(), model->images[0].uses.end(),
                                     [](const ImageUse& use) { return use.is_color; });
    EXPECT_EQ(color, 1);
    EXPECT_EQ(model->images[1].uses[0].slot, "metallicRoughnessTexture");
    EXPECT_TRUE(model->images[1].bytes.empty());
    const auto texture = read_map(*model, model->maps[0]);
    ASSERT_TRUE(texture) << texture.error().message();
    EXPECT_EQ(texture->extent().width, 8);
}

// Exporters may describe a file or a view once for each of its uses.
TEST_F(Models, ImagesOfTheSameBytesShareTheirUses) {
    const std::string view = std::to_string(maker_.add_view(picture({8, 8})));
    const auto model = read(
        R"("materials":[{"normalTexture":{"index":0},"emissiveTexture":{"index":1}},{"normalTexture":{"index":2},)"
        R"("occlusionTexture":{"index":3}},{"normalTexture":{"index":4}}],)"
        R"("textures":[{"source":0},{"source":1},{"source":2},{"source":3},{"source":4}],"images":[{"bufferView":)" +
        view + R"(},{"bufferView":)" + view + R"(},{"uri":"a%62.png"},{"uri":"./ab.png"},{"uri":"ba.png"}])");
    ASSERT_TRUE(model) << model.error().message();
    for (const std::size_t k : {0U, 1U, 2U, 3U}) EXPECT_EQ(model->images[k].uses.size(), 2u) << k;
    EXPECT_EQ(model->images[0].uses[0].slot, "emissiveTexture");
    EXPECT_EQ(model->images[2].uses[1].slot, "occlusionTexture");
    EXPECT_EQ(model->images[4].uses.size(), 1u);
    const auto reports = check_model(path("m.glb"));
    ASSERT_TRUE(reports);
    const auto& findings = reports->front().findings;
    EXPECT_TRUE(std::any_of(findings.begin(), findings.end(),
                            [](const Finding& finding) { return finding.rule->id == "N802"; }));
}

// A FIFO would never end.
TEST_F(Models, FilesThatAreNoneAreNotOpened) {
    ASSERT_EQ(mkfifo((path("fifo")).c_str(), 0600), 0);
    const auto model =
        read(R"("materials":[{"normalTexture":{"index":0}}],"textures":[{"source":0}],"images":[{"uri":"fifo"}])");
    ASSERT_TRUE(model) << model.error().message();
    const auto map = read_map(*model, model->maps[0]);
    ASSERT_FALSE(map);
    EXPECT_EQ(map.error().code, ErrorCode::io);
    EXPECT_EQ(map.error().reason, "is not a regular file");
    GltfMaker maker = maker_;
    maker.uri = "\"uri\":\"fifo\",";
    std::ofstream(path("b.gltf")) << maker.json(R"({"attributes":{"POSITION":0}})");
    const auto mesh = read_mesh(path("b.gltf"));
    ASSERT_FALSE(mesh);
    EXPECT_EQ(mesh.error().code, ErrorCode::io);
    EXPECT_EQ(mesh.error().reason, "is not a regular file, which b.gltf names");
}

// What is wrong with one image is that image's error; the model is read.
TEST_F(Models, DamagedImagesAreTheirOwnErrors) {
    const auto model = read(
        R"("materials":[{"normalTexture":{"index":0}},{"normalTexture":{"index":1}},{"normalTexture":{"index":2}},)"
        R"({"normalTexture":{"index":9}},{"normalTexture":{"index":3}}],)"
        R"("textures":[{"source":0},{"source":1},{"source":2},{"source":3}],)"
        R"("images":[{"uri":"../up.png"},{"bufferView":77},{"uri":"data:image/png;base64,####"},{"uri":"none.png"}])");
    ASSERT_TRUE(model) << model.error().message();
    ASSERT_EQ(model->maps.size(), 5u);
    for (std::size_t k = 0; k < 4; ++k) {
        const auto texture = read_map(*model, model->maps[k]);
        ASSERT_FALSE(texture) << k;
        EXPECT_NE(texture.error().code, ErrorCode::io) << k;
    }
    EXPECT_EQ(read_map(*model, model->maps[4]).error().code, ErrorCode::io);
    const auto reports = check_model(path("m.glb"));
    ASSERT_TRUE(reports);
    ASSERT_EQ(reports->size(), 5u);
    EXPECT_EQ(reports->front().map, "0: image 0");
    EXPECT_EQ(reports->front().findings.front().rule->id, "N101");
}

TEST_F(Models, SelectionFindsTheMaterialWhateverNamesAre) {
    const auto model = read(R"("materials":[{"name":"1"},{"name":"stone","normalTexture":{"index":0,"texCoord":0}}],)"
                            R"("textures":[{"source":0}],"images":[{"uri":"a.png"}])",
                            "1");
    ASSERT_TRUE(model) << model.error().message();
    const MeshSelection selection = selection_of(*model, model->maps[0]);
    const auto selected = select_part(model->mesh, selection);
    ASSERT_TRUE(selected) << selected.error().reason;
    EXPECT_TRUE(selected->has_normal_map);
    EXPECT_FALSE(selection.uv_set);
}

TEST_F(Models, OtherFilesAreNone) {
    write("a.png", picture({4, 4}));
    EXPECT_FALSE(is_model(path("a.png")));
    EXPECT_FALSE(is_model(path("none")));
    EXPECT_FALSE(is_model("-"));
    EXPECT_EQ(read_model(path("a.png")).error().code, ErrorCode::unsupported);
    EXPECT_EQ(read_model("-").error().code, ErrorCode::unsupported);
    EXPECT_EQ(read_model(path("none")).error().code, ErrorCode::io);
}

// The map of a model that gltfpack made is checked where the sheet has it.
TEST(ModelData, QuantisedModelsAreCheckedOnTheirMesh) {
    const std::string file = TEX_SOURCE_DIR "/../shared/data/wild/gltfpack_default_quantized.glb";
    if (!fs::exists(file)) GTEST_SKIP() << "no ../shared/data";
    const auto reports = check_model(file);
    ASSERT_TRUE(reports) << reports.error().message();
    ASSERT_EQ(reports->size(), 1u);
    EXPECT_EQ(reports->front().map, "m: image 0");
    EXPECT_FALSE(reports->front().error);
    EXPECT_TRUE(reports->front().y_on_mesh);
    for (const Finding& finding : reports->front().findings) EXPECT_EQ(finding.rule->id, "N701");
}

}  // namespace
}  // namespace tex
