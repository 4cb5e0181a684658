// SPDX-License-Identifier: Apache-2.0
//
// tests/golden has files as text: bytes in hexadecimal and, after '#', their meaning and why they are right. They were
// written from the specifications of the containers, by a program that shares nothing with libtex.
//
// Each file has one texture: 6x5 texels and a level of 3x2; the k-th byte of level l is 7 k + 64 l + 1.

#include <tex/file.h>

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "unit/textures.h"

namespace tex {
namespace {

std::vector<std::byte> golden_bytes(const std::filesystem::path& path) {
    std::vector<std::byte> bytes;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        std::istringstream numbers(line.substr(0, line.find('#')));
        for (unsigned byte = 0; numbers >> std::hex >> byte;) bytes.push_back(static_cast<std::byte>(byte));
    }
    return bytes;
}

// DDS and KTX2 widen three channels by A = 1. With that in A, the encodings with alpha are the same files.
Encoding golden_encoding(Encoding encoding) {
    if (encoding == Encoding::rgba16) return Encoding::rgb16;
    if (encoding == Encoding::rgba16f) return Encoding::half;
    return encoding == Encoding::rgba32f ? Encoding::float_ : encoding;
}

std::string golden_name(Encoding encoding) { return std::string(name_of(kEncodingNames, golden_encoding(encoding))); }

// The bytes of A = 1.
std::vector<std::byte> golden_alpha(Encoding encoding) {
    if (encoding == Encoding::rgba16) return {std::byte{0xff}, std::byte{0xff}};
    if (encoding == Encoding::rgba16f) return {std::byte{0x00}, std::byte{0x3c}};
    return {std::byte{0x00}, std::byte{0x00}, std::byte{0x80}, std::byte{0x3f}};
}

Texture golden_texture(Encoding encoding) {
    Texture texture = encoded_texture(encoding, {6, 5}, 2);
    const bool is_widened = golden_encoding(encoding) != encoding;
    for (std::size_t l = 0; l < 2; ++l) {
        std::vector<std::byte>& bytes = texture.levels[l].bytes;
        const std::size_t texels = is_widened ? 4 * golden_alpha(encoding).size() : bytes.size();
        std::size_t k = 0;  // of the bytes without A
        for (std::size_t at = 0; at < bytes.size(); ++at) {
            const std::size_t in_texel = at % texels, colors = is_widened ? texels / 4 * 3 : texels;
            bytes[at] = in_texel >= colors ? golden_alpha(encoding)[in_texel - colors]
                                           : static_cast<std::byte>((7 * k++ + 64 * l + 1) & 0xff);
        }
    }
    return texture;
}

void expect_golden(const std::string& file, Encoding encoding, Container container, const WriteOptions& options) {
    const std::filesystem::path path = std::filesystem::path(TEX_SOURCE_DIR "/tests/golden") / (file + ".txt");
    ASSERT_TRUE(std::filesystem::exists(path)) << path;
    const std::vector<std::byte> expected = golden_bytes(path);
    const auto bytes = encode_file(golden_texture(encoding), container, options);
    ASSERT_TRUE(bytes);
    ASSERT_EQ(bytes->size(), expected.size()) << file;
    for (std::size_t k = 0; k < expected.size(); ++k) {
        ASSERT_EQ(std::to_integer<int>((*bytes)[k]), std::to_integer<int>(expected[k])) << file << " at byte " << k;
    }
}

TEST(Golden, EveryEncodingInKtx2) {
    for (const auto& row : kEncodingNames) {
        expect_golden(golden_name(row.value) + ".ktx2", row.value, Container::ktx2, {});
    }
}

TEST(Golden, EveryEncodingInLegacyDds) {
    for (const auto& row : kEncodingNames) {
        if (!can_hold(Container::dds, row.value)) continue;
        expect_golden(golden_name(row.value) + ".dds", row.value, Container::dds, {});
    }
}

TEST(Golden, EveryEncodingInDx10Dds) {
    WriteOptions options;
    options.dds_header = DdsHeader::dx10;
    // These are the same with either header: DXGI has no rgb8, Direct3D 9 has no rg8, rg16 and bc7, and ag8 is rgba8
    // except for its alpha mode.
    for (const auto& row : kEncodingNames) {
        const std::string name = golden_name(row.value);
        if (name == "ag8" || !can_hold(Container::dds, row.value)) continue;
        const bool only_one = name == "rgb8" || name == "rg8" || name == "rg16" || name.starts_with("bc7");
        expect_golden(name + (only_one ? ".dds" : "-dx10.dds"), row.value, Container::dds, options);
    }
}

TEST(Golden, MarkedDxt5nm) {
    WriteOptions options;
    options.dds_mark = true;
    expect_golden("dxt5nm-marked.dds", Encoding::dxt5nm, Container::dds, options);
}

}  // namespace
}  // namespace tex
