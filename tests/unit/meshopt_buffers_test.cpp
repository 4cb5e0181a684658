// SPDX-License-Identifier: Apache-2.0
// Buffers that meshoptimizer compressed. tests/peers/gltf_tools_test.cpp compares whole files of gltfpack.

#include "mesh/meshopt_buffers.h"

#include <cstdint>
#include <cstring>
#include <fstream>
#include <iomanip>
#include <map>
#include <sstream>

#include <gtest/gtest.h>

#include "mesh/gltf.h"
#include "unit/gltf_files.h"

namespace tex {
namespace {

std::vector<std::byte> bytes_of(std::initializer_list<int> values) {
    std::vector<std::byte> bytes;
    for (const int value : values) bytes.push_back(static_cast<std::byte>(value));
    return bytes;
}

struct Sample {
    std::string name;
    MeshoptLayout layout;
    std::vector<std::byte> packed;
    std::string digest;  // of the decoded bytes

    [[nodiscard]] std::size_t size() const { return layout.count * layout.stride; }
};

std::vector<std::byte> from_hex(const std::string& text) {
    std::vector<std::byte> bytes;
    for (std::size_t k = 0; k + 1 < text.size(); k += 2)
        bytes.push_back(static_cast<std::byte>(std::stoi(text.substr(k, 2), nullptr, 16)));
    return bytes;
}

// FNV-1a
std::string digest_of(const std::vector<std::byte>& bytes) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const std::byte byte : bytes) hash = (hash ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3u;
    std::ostringstream text;
    text << std::hex << std::setw(16) << std::setfill('0') << hash;
    return text.str();
}

// What meshoptimizer encoded and decoded (tests/peers/meshopt.mjs).
std::vector<Sample> samples() {
    const std::map<std::string, MeshoptMode> modes = {{"ATTRIBUTES", MeshoptMode::attributes},
                                                      {"TRIANGLES", MeshoptMode::triangles},
                                                      {"INDICES", MeshoptMode::indices}};
    const std::map<std::string, MeshoptFilter> filters = {{"NONE", MeshoptFilter::none},
                                                          {"OCTAHEDRAL", MeshoptFilter::octahedral},
                                                          {"QUATERNION", MeshoptFilter::quaternion},
                                                          {"EXPONENTIAL", MeshoptFilter::exponential}};
    std::vector<Sample> all;
    std::ifstream file(TEX_SOURCE_DIR "/tests/golden/meshopt.txt");
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with('#')) continue;
        std::istringstream words(line);
        std::string mode, filter, packed;
        Sample sample;
        words >> sample.name >> mode >> filter >> sample.layout.count >> sample.layout.stride >> packed >>
            sample.digest;
        sample.layout.mode = modes.at(mode);
        sample.layout.filter = filters.at(filter);
        sample.packed = from_hex(packed);
        all.push_back(std::move(sample));
    }
    return all;
}

TEST(MeshoptBuffers, DecodeAsMeshoptimizerDoes) {
    int compared = 0;
    for (const Sample& sample : samples()) {
        const auto decoded = decode_meshopt(sample.layout, sample.packed);
        ASSERT_TRUE(decoded) << sample.name << ": " << decoded.error().reason;
        EXPECT_EQ(digest_of(*decoded), sample.digest) << sample.name;
        ++compared;
    }
    EXPECT_EQ(compared, 33);
}

TEST(MeshoptBuffers, RefuseTruncationAndMoreBytes) {
    for (Sample& sample : samples()) {
        for (std::size_t size = 0; size < sample.packed.size(); size += 1 + sample.packed.size() / 100) {
            const std::span part(sample.packed.data(), size);
            EXPECT_FALSE(decode_meshopt(sample.layout, part)) << sample.name << ", " << size << " bytes";
        }
        sample.packed.insert(sample.packed.begin() + 1, 8, std::byte{});
        const auto longer = decode_meshopt(sample.layout, sample.packed);
        EXPECT_TRUE(!longer || longer->size() == sample.size()) << sample.name;
    }
}

// Any byte may be wrong: the result is refused or has its size.
TEST(MeshoptBuffers, SurviveEveryWrongByte) {
    for (const Sample& sample : samples()) {
        for (std::size_t at = 0; at < sample.packed.size(); at += 1 + sample.packed.size() / 500) {
            std::vector<std::byte> wrong = sample.packed;
            wrong[at] ^= std::byte{0x5b};
            const auto decoded = decode_meshopt(sample.layout, wrong);
            EXPECT_TRUE(!decoded || decoded->size() == sample.size()) << sample.name;
        }
    }
}

TEST(MeshoptBuffers, RefuseImpossibleLayouts) {
    const std::vector<std::byte> packed = samples().front().packed;
    for (const MeshoptLayout& layout : {MeshoptLayout{MeshoptMode::triangles, MeshoptFilter::none, 14, 4},
                                        MeshoptLayout{MeshoptMode::triangles, MeshoptFilter::none, 15, 3},
                                        MeshoptLayout{MeshoptMode::indices, MeshoptFilter::octahedral, 15, 4},
                                        MeshoptLayout{MeshoptMode::attributes, MeshoptFilter::none, 15, 6},
                                        MeshoptLayout{MeshoptMode::attributes, MeshoptFilter::none, 15, 260},
                                        MeshoptLayout{MeshoptMode::attributes, MeshoptFilter::octahedral, 15, 12},
                                        MeshoptLayout{MeshoptMode::attributes, MeshoptFilter::quaternion, 15, 4}})
        EXPECT_FALSE(decode_meshopt(layout, packed));
}

TEST(MeshoptBuffers, FiltersGiveUnitVectorsAndNumbers) {
    // (1, -2, 2) / 3 in octahedral form with 7 bits: x and y over the sum of magnitudes.
    auto octahedral = bytes_of({25, -51 & 0xff, 127, 5});
    apply_meshopt_filter(MeshoptFilter::octahedral, 4, octahedral);
    const auto component = [&](std::size_t k) { return static_cast<std::int8_t>(std::to_integer<int>(octahedral[k])); };
    EXPECT_NEAR(component(0), 127.0 / 3.0, 1.0);
    EXPECT_NEAR(component(1), -254.0 / 3.0, 1.0);
    EXPECT_NEAR(component(2), 254.0 / 3.0, 1.0);
    EXPECT_EQ(component(3), 5);
    // 5 * 2^-3, -3 * 2^2
    auto exponential = bytes_of({5, 0, 0, -3 & 0xff, 0xfd, 0xff, 0xff, 2});
    apply_meshopt_filter(MeshoptFilter::exponential, 8, exponential);
    float values[2];
    std::memcpy(values, exponential.data(), sizeof values);
    EXPECT_EQ(values[0], 0.625f);
    EXPECT_EQ(values[1], -12.0f);
}

// A buffer of zeros takes almost no bytes; what it claims is limited by those that the file has.
TEST(MeshoptBuffers, RefusesClaimsOutOfProportion) {
    GltfMaker maker;
    maker.add_view(std::vector<std::uint8_t>(64, 0));
    maker.views += R"(,{"buffer":0,"byteLength":12,"extensions":{"EXT_meshopt_compression":{"buffer":0,"byteOffset":0,)"
                   R"("byteLength":64,"byteStride":4,"mode":"ATTRIBUTES","count":4000000000}}})";
    maker.add_accessor(3, "VEC3", 5126, ",\"bufferView\":1");
    const std::string file = maker.glb(R"({"attributes":{"POSITION":0}})");
    const auto mesh = parse_gltf({reinterpret_cast<const std::byte*>(file.data()), file.size()}, {});
    ASSERT_FALSE(mesh);
    EXPECT_EQ(mesh.error().code, ErrorCode::unsupported);
    EXPECT_NE(mesh.error().reason.find("claims too many elements"), std::string::npos) << mesh.error().reason;
}

}  // namespace
}  // namespace tex
