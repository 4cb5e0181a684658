// SPDX-License-Identifier: Apache-2.0
// convert-normals in every encoding, with what is beside the normals: nothing, kept, given, more than there is room
// for. Its files have the bytes of the verbs in memory. tests/unit/extras_matrix_test.cpp does the same with what works
// row by row.

#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tex/tex.h>

#include "cli/meshes.h"
#include "cli/program.h"
#include "unit/normal_maps.h"

namespace tex::cli {
namespace {

constexpr Extent kSquare{16, 16};

Plane<float> codes_beside(int factor) {
    Plane<float> plane(kSquare);
    for (int k = 0; k < kSquare.texels(); ++k)
        plane.at(k % kSquare.width, k / kSquare.width) = static_cast<float>(factor * k % 256) / 255.0f;
    return plane;
}

class ExtrasMatrix : public testing::Test {
protected:
    ExtrasMatrix() {
        scratch_.write("sheet.obj", kSheetObj);
        for (const bool has_alpha : {false, true}) {
            NormalMap map = wavy_map(kSquare);
            if (has_alpha) map.alpha = codes_beside(7);
            write(has_alpha ? "a.ktx2" : "n.ktx2", pack(chain_from(std::move(map)), {Encoding::rgba16}).value());
        }
        RoughnessChain given;
        given.levels.push_back(codes_beside(11));
        write("given.png", pack_roughness(given, Format::r8_unorm).value());
    }
    void write(const std::string& name, const Texture& texture) const {
        EXPECT_TRUE(write_texture(scratch_.path(name), texture));
    }
    // What the command does, in memory.
    [[nodiscard]] std::string converted(const std::string& input, std::optional<Extra> given, Encoding encoding) const {
        const Mesh mesh = read_mesh(scratch_.path("sheet.obj")).value();
        const SelectedPart selected = select_part(mesh, {}).value();
        const auto space = [&](Decoder decoder) { return TangentSpace{selected.part, selected.tangents, 0, decoder}; };
        NormalMap map = std::move(read_normals(scratch_.path(input)).value().chain.levels[0]);
        map = std::move(refit(map, space(Decoder::gltf), space(Decoder::unity_builtin)).value().map);
        if (given) map[*given] = codes_beside(11);
        const MipChain chain = build_mip_chain(std::move(map)).value();
        const auto bytes = encode_file(pack(chain, {encoding}).value(), Container::ktx2).value();
        return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    }
    Scratch scratch_;
};

TEST_F(ExtrasMatrix, ConversionsInEveryEncoding) {
    // None: what the input has is kept.
    constexpr std::optional<Extra> kGiven[] = {std::nullopt, Extra::alpha, Extra::blue, Extra::length};
    for (const auto& row : kEncodingNames) {
        const ExtraSet held = can_hold(row.value);
        for (const std::string input : {"n.ktx2", "a.ktx2"}) {
            for (const std::optional<Extra> given : kGiven) {
                const std::string option = given ? "--" + std::string(name_of(kExtraNames, *given)) : "";
                if (given && input == "n.ktx2") continue;
                const std::string what = std::string(row.name) + ' ' + input + ' ' + option;
                std::vector<std::string> line = {
                    input,  "-o",        "o.ktx2",        "--no-sync", "--mesh", "sheet.obj", "--decoder-in",
                    "gltf", "--decoder", "unity-builtin", "--y",       "up",     "--format",  std::string(row.name)};
                if (row.value == Encoding::uastc || row.value == Encoding::uastc_rrrg)
                    line.insert(line.end(), {"--supercompress", "none"});
                if (given) line.insert(line.end(), {option, "given.png"});
                const Ran ran = run(scratch_, "convert-normals", line);
                if (given && !held[*given]) {
                    EXPECT_EQ(ran.code, 2) << what;
                    EXPECT_NE(ran.err.find("these formats have: "), std::string::npos) << what << ran.err;
                    continue;
                }
                ASSERT_EQ(ran.code, 0) << what << ran.err;
                const bool loses = input == "a.ktx2" && !held.alpha && given != Extra::alpha;
                EXPECT_EQ(ran.err.find("A (0") != std::string::npos, loses) << what << ran.err;
                EXPECT_EQ(scratch_.read("o.ktx2") == converted(input, given, row.value), true) << what;
            }
        }
    }
}

}  // namespace
}  // namespace tex::cli
