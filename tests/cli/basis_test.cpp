// SPDX-License-Identifier: Apache-2.0
// KTX2 files of Basis Universal, alone and in glTF models (KHR_texture_basisu), as commands read them.

#include <cstdint>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace tex::cli {
namespace {

constexpr std::size_t kDescriptorAt = 48, kTransfer = 14, kChannel = 31;

// A triangle with a material whose normal map is texture 0.
std::string model_with(const std::string& textures, const std::string& images) {
    return R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_texture_basisu"],)"
           R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},"material":0}]}],)"
           R"("nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}],)"
           R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},)"
           R"({"bufferView":1,"componentType":5126,"count":3,"type":"VEC3"},)"
           R"({"bufferView":2,"componentType":5126,"count":3,"type":"VEC2"}],"bufferViews":[)"
           R"({"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":36},)"
           R"({"buffer":0,"byteOffset":72,"byteLength":24}],"buffers":[{"uri":"t.bin","byteLength":96}],)"
           R"("materials":[{"normalTexture":{"index":0}}],"textures":)" +
           textures + R"(,"images":)" + images + "}";
}

}  // namespace

class Basis : public testing::Test {
protected:
    Basis() {
        EXPECT_EQ(shell(scratch_, "for k in uastc-zstd etc1s-rgb etc1s-two-slices; do cp " TEX_SOURCE_DIR
                                  "/tests/fuzz/corpus/ktx2/basis-$k $k.ktx2; done")
                      .code,
                  0);
        const float mesh[24] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 1, 1, 1, 0, 0};
        scratch_.write("t.bin", std::string(reinterpret_cast<const char*>(mesh), sizeof mesh));
    }
    // Changes a byte of the data format descriptor.
    void set(const std::string& name, std::size_t at, int value) {
        std::string file = scratch_.read(name);
        file[static_cast<std::size_t>(static_cast<unsigned char>(file[kDescriptorAt])) + at] = static_cast<char>(value);
        scratch_.write(name, file);
    }
    // The ids of what check-normals finds, with blanks between them.
    std::string found(const std::string& file) {
        const Ran ran = shell(scratch_, "check-normals --json --disable N106 --disable N701 " + file);
        std::string ids;
        const auto report = nlohmann::json::parse(ran.out, nullptr, false);
        if (report.is_discarded()) return ran.out + ran.err;
        for (const auto& finding : report["findings"]) ids += (ids.empty() ? "" : " ") + std::string(finding["id"]);
        return ids;
    }
    Scratch scratch_;
};

TEST_F(Basis, FilesOfNormalsAreSoundUnlessTheySaySrgb) {
    EXPECT_EQ(found("uastc-zstd.ktx2").find("N1"), std::string::npos);
    EXPECT_EQ(found("etc1s-two-slices.ktx2").find("N1"), std::string::npos);
    EXPECT_EQ(found("etc1s-rgb.ktx2").find("N1"), std::string::npos);
    for (const char* name : {"uastc-zstd.ktx2", "etc1s-rgb.ktx2"}) {
        set(name, kTransfer, 2);  // sRGB
        EXPECT_NE(found(name).find("N111"), std::string::npos) << name;
    }
    set("uastc-zstd.ktx2", kChannel, 4);  // RRR
    EXPECT_NE(found("uastc-zstd.ktx2").find("N114"), std::string::npos);
}

TEST_F(Basis, ModelsAreReadWithAndWithoutAFallback) {
    scratch_.write("only.gltf", model_with(R"([{"extensions":{"KHR_texture_basisu":{"source":0}}}])",
                                           R"([{"uri":"uastc-zstd.ktx2"}])"));
    EXPECT_EQ(shell(scratch_, "unpack-normals uastc-zstd.ktx2 -o n.png").code, 0);
    scratch_.write("both.gltf", model_with(R"([{"source":1,"extensions":{"KHR_texture_basisu":{"source":0}}}])",
                                           R"([{"uri":"uastc-zstd.ktx2"},{"uri":"n.png"}])"));
    for (const std::string model : {"only.gltf", "both.gltf"}) {
        EXPECT_EQ(found(model).find("N1"), std::string::npos) << found(model);
        EXPECT_EQ(found(model).find("N8"), std::string::npos) << found(model);
        EXPECT_EQ(shell(scratch_, "preview-normals " + model + " -o p.png --size 64x64").code, 0);
    }
    set("uastc-zstd.ktx2", kChannel, 5);  // RRRG: z is not there
    EXPECT_NE(found("only.gltf").find("N801"), std::string::npos) << found("only.gltf");
}

TEST_F(Basis, CommandsConvertThem) {
    for (const std::string name : {"uastc-zstd", "etc1s-rgb", "etc1s-two-slices"}) {
        const std::string file = name + ".ktx2";
        EXPECT_EQ(shell(scratch_, "unpack-normals " + file + " -o " + name + ".exr").code, 0) << name;
        EXPECT_EQ(shell(scratch_, "pack-normals " + file + " -o " + name + ".dds --format bc5").code, 0) << name;
        EXPECT_EQ(shell(scratch_, "pack-normals " + file + " -o " + name + ".png --format rgb8").code, 0) << name;
        const Ran compared = shell(scratch_, "compare-normals " + file + " " + name + ".exr --max-mean 0.1");
        EXPECT_EQ(compared.code, 0) << compared.out << compared.err;
    }
}

}  // namespace tex::cli
