// SPDX-License-Identifier: Apache-2.0
// Every field of a DDS with legal and illegal values, written without libtex. The file must be read correctly or
// refused.

#include "reference/dds_file.h"

#include <gtest/gtest.h>

#include "formats/dds/dds.h"

namespace tex {
namespace {

using reference::DdsFile;
namespace dds = reference::dds;

Result<Texture> read(const DdsFile& file) {
    const std::string bytes = reference::write_dds(file);
    ReadOptions options;
    options.max_texels = 1 << 20;
    return load_texture(parse_dds, reinterpret_cast<const std::byte*>(bytes.data()), bytes.size(), "a.dds", options);
}

// 12x8 and the three levels below it: BC5 in both headers, and RGBA of 8 bits.
std::vector<DdsFile> plain_files() {
    std::vector<DdsFile> files = {reference::dds_coded(12, 8, 4, reference::four_cc("ATI2")),
                                  reference::dds_dxgi(12, 8, 4, 83), reference::dds_dxgi(12, 8, 4, 28)};
    for (std::size_t k = 0; k < files.size(); ++k) {
        const std::size_t size = k < 2 ? (3 * 2 + 2 + 1 + 1) * 16 : (12 * 8 + 6 * 4 + 3 * 2 + 1) * 4;
        for (std::size_t at = 0; at < size; ++at) files[k].data += static_cast<char>(at * 37);
    }
    return files;
}

constexpr std::uint32_t kValues[] = {0,      1,       2,      3,        4,          5,          6,          7,
                                     8,      12,      13,     15,       16,         31,         32,         64,
                                     124,    128,     0xff,   0x1007,   0xfe00,     0x20000,    0x41,       0x80000,
                                     0x8000, 0x10000, 0xffff, 0xff0000, 0x7fffffff, 0x80000000, 0xfffffffe, 0xffffffff};

}  // namespace

TEST(DdsFields, WhatTheyAreMadeOfIsRead) {
    const std::vector<DdsFile> files = plain_files();
    for (std::size_t k = 0; k < files.size(); ++k) {
        const Result<Texture> texture = read(files[k]);
        ASSERT_TRUE(texture) << texture.error().message();
        EXPECT_EQ(texture->format, k < 2 ? Format::bc5_unorm : Format::rgba8_unorm);
        ASSERT_EQ(texture->levels.size(), 4u);
        std::string data;
        for (const Level& level : texture->levels)
            data.append(reinterpret_cast<const char*>(level.bytes.data()), level.bytes.size());
        EXPECT_TRUE(data == files[k].data);
    }
}

TEST(DdsFields, AnyFieldMayHoldAnything) {
    for (const DdsFile& plain : plain_files()) {
        for (std::size_t field = 0; field < (plain.has_header10 ? dds::kHeader10End : dds::kHeaderEnd); field += 4) {
            for (const std::uint32_t value : kValues) {
                SCOPED_TRACE(testing::Message() << "field " << field << " = " << value);
                DdsFile file = plain;
                file[field] = value;
                const Result<Texture> texture = read(file);
                if (!texture) {
                    EXPECT_FALSE(texture.error().reason.empty());
                    EXPECT_TRUE(texture.error().code == ErrorCode::bad_data ||
                                texture.error().code == ErrorCode::unsupported)
                        << texture.error().reason;
                    continue;
                }
                std::size_t bytes = 0;
                for (const Level& level : texture->levels) {
                    EXPECT_EQ(level.bytes.size(), level_bytes(texture->format, level.extent));
                    bytes += level.bytes.size();
                }
                EXPECT_LE(bytes, 2 * plain.data.size());  // three channels may be widened to four
            }
        }
    }
}

TEST(DdsFields, EveryFormatIsReadOrRefused) {
    for (std::uint32_t code = 0; code < 256; ++code) {
        for (const DdsFile& header : {reference::dds_dxgi(4, 4, 1, code), reference::dds_coded(4, 4, 1, code)}) {
            DdsFile file = header;
            for (const std::size_t size : {0u, 15u, 256u}) {
                file.data.assign(size, '\x55');
                const Result<Texture> texture = read(file);
                EXPECT_TRUE(texture || !texture.error().reason.empty()) << code;
                EXPECT_TRUE(size > 0 || !texture) << code;
            }
        }
    }
}

}  // namespace tex
