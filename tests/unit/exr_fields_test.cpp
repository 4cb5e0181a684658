// SPDX-License-Identifier: Apache-2.0
// Every field of an EXR with legal and illegal values, written without OpenEXR. The file must be read correctly or
// refused.

#include "reference/exr_file.h"

#include <gtest/gtest.h>

#include <cstring>

#include "formats/exr/exr.h"
#include "formats/exr/exr_rows.h"

namespace tex {
namespace {

using reference::ExrAttribute;
using reference::ExrFile;

constexpr int kFieldsWidth = 5, kFieldsHeight = 3;

float value_of(int i, int j) { return static_cast<float>(i * 3 - j * 5) / 16.0f; }

// One channel of floats.
std::string rows() {
    std::string bytes;
    for (int j = 0; j < kFieldsHeight; ++j) {
        for (int i = 0; i < kFieldsWidth; ++i) {
            std::uint32_t bits = 0;
            const float value = value_of(i, j);
            std::memcpy(&bits, &value, sizeof bits);
            reference::put_little(bytes, bits, 4);
        }
    }
    return bytes;
}

std::vector<ExrFile> plain_files() {
    return {reference::exr_scan_lines(kFieldsWidth, kFieldsHeight, {{"Y", 2}}, rows()),
            reference::exr_tile(kFieldsWidth, kFieldsHeight, {{"Y", 2}}, rows())};
}

InputFile input_of(const ExrFile& file) {
    const std::string text = reference::write_exr(file);
    const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
    return std::move(*InputFile::from_memory("a.exr", {bytes, bytes + text.size()}));
}

ReadOptions limited() {
    ReadOptions options;
    options.max_texels = 1 << 20;
    return options;
}

bool is_plain(const Image& image) {
    if (image.extent() != Extent{kFieldsWidth, kFieldsHeight} || image.planes.size() != 1) return false;
    for (int j = 0; j < kFieldsHeight; ++j) {
        for (int i = 0; i < kFieldsWidth; ++i) {
            if (image.planes[0].at(i, j) != value_of(i, j)) return false;
        }
    }
    return true;
}

// Reads the file as a whole and by rows. Both must have the same result, or be refused with a reason. Returns true if
// it was read.
bool expect_read_or_refused(const ExrFile& file) {
    InputFile input = input_of(file);
    const Result<Image> image = read_all(open_exr_rows(input, limited()));
    if (!image) {
        EXPECT_FALSE(image.error().reason.empty());
        EXPECT_TRUE(image.error().code == ErrorCode::bad_data || image.error().code == ErrorCode::unsupported)
            << image.error().reason;
    }
    const auto source = open_exr_rows(input, limited());
    EXPECT_TRUE(source || !image);
    if (!source) return false;
    const Result<Image> by_rows = (*source)->read_all();
    EXPECT_EQ(static_cast<bool>(by_rows), static_cast<bool>(image));
    const auto texture = read_all(open_exr_texture_rows(input, limited()));
    if (texture && texture->levels.empty()) ADD_FAILURE() << "no levels";
    return static_cast<bool>(image);
}

// Integers for which headers are often wrong.
constexpr std::uint32_t kIntegers[] = {0,          1,          2,          3,          0x7f,       0xff,
                                       0x7fff,     0xffff,     0x10000,    0x3fffffff, 0x40000000, 0x7ffffffe,
                                       0x7fffffff, 0x80000000, 0x80000001, 0xfffffffe, 0xffffffff, 0x7fc00000};

}  // namespace

TEST(ExrFields, WhatTheyAreMadeOfIsRead) {
    for (const ExrFile& file : plain_files()) {
        InputFile input = input_of(file);
        const Result<Image> image = read_all(open_exr_rows(input, limited()));
        ASSERT_TRUE(image) << image.error().message();
        EXPECT_TRUE(is_plain(*image));
        const std::string text = reference::write_exr(file);
        const auto again = reference::parse_exr(text);
        ASSERT_TRUE(again);
        EXPECT_EQ(reference::write_exr(*again), text);
    }
}

TEST(ExrFields, AnyAttributeMayBeMissing) {
    for (const ExrFile& plain : plain_files()) {
        for (std::size_t k = 0; k < plain.parts[0].size(); ++k) {
            ExrFile file = plain;
            SCOPED_TRACE(file.parts[0][k].name);
            file.parts[0].erase(file.parts[0].begin() + static_cast<std::ptrdiff_t>(k));
            // OpenEXR uses defaults if the other attributes are missing.
            const std::string& name = plain.parts[0][k].name;
            const bool is_needed = name == "channels" || name == "dataWindow" || name == "tiles";
            EXPECT_TRUE(!expect_read_or_refused(file) || !is_needed);
        }
    }
}

TEST(ExrFields, AnyAttributeMayHaveAnotherTypeOrSize) {
    for (const ExrFile& plain : plain_files()) {
        for (std::size_t k = 0; k < plain.parts[0].size(); ++k) {
            SCOPED_TRACE(plain.parts[0][k].name);
            for (const char* type :
                 {"int", "float", "string", "chlist", "box2i", "tiledesc", "preview", "nothing", ""}) {
                ExrFile file = plain;
                file.parts[0][k].type = type;
                expect_read_or_refused(file);
            }
            for (const std::uint32_t size : kIntegers) {
                ExrFile file = plain;
                file.parts[0][k].size = size;
                expect_read_or_refused(file);
                file = plain;
                file.parts[0][k].value.resize(std::min<std::size_t>(size, 300), 'v');
                expect_read_or_refused(file);
            }
        }
    }
}

TEST(ExrFields, AnyValueMayBeAnything) {
    for (const ExrFile& plain : plain_files()) {
        for (std::size_t k = 0; k < plain.parts[0].size(); ++k) {
            SCOPED_TRACE(plain.parts[0][k].name);
            for (std::size_t at = 0; at < plain.parts[0][k].value.size(); ++at) {
                for (const std::uint32_t value : kIntegers) {
                    ExrFile file = plain;
                    std::string& bytes = file.parts[0][k].value;
                    const std::string field = reference::little({value}, 4).substr(0, bytes.size() - at);
                    bytes.replace(at, field.size(), field);
                    expect_read_or_refused(file);
                }
            }
        }
    }
}

// Attributes for other types of parts, or for no type, must not change a file of scan lines.
TEST(ExrFields, AttributesOfOtherPartsChangeNothing) {
    const ExrFile plain = plain_files()[0];
    for (const std::uint32_t side : kIntegers) {
        for (const char mode : {'\0', '\1', '\2', '\x10', '\x7f'}) {
            ExrFile file = plain;
            file.parts[0].push_back({"tiles", "tiledesc", reference::exr_tiles(64, side, mode)});
            if (mode == '\x7f') {  // no such mode, so the file may be refused
                expect_read_or_refused(file);
                continue;
            }
            InputFile input = input_of(file);
            const Result<Image> image = read_all(open_exr_rows(input, limited()));
            ASSERT_TRUE(image) << image.error().message();
            EXPECT_TRUE(is_plain(*image));
            EXPECT_TRUE(expect_read_or_refused(file));
        }
        for (const char* name : {"chunkCount", "maxSamplesPerPixel", "version", "unknown"}) {
            ExrFile file = plain;
            file.parts[0].push_back({name, "int", reference::little({side}, 4)});
            expect_read_or_refused(file);
        }
    }
}

TEST(ExrFields, VersionsAndKindsOfPartsMayContradictTheParts) {
    for (const ExrFile& plain : plain_files()) {
        for (std::uint32_t bits = 0; bits < 64; ++bits) {
            ExrFile file = plain;
            file.version = (bits & 3) + (bits >> 2) * ExrFile::kTiled;
            expect_read_or_refused(file);
            for (const char* type : {"scanlineimage", "tiledimage", "deepscanline", "deeptile", "none"}) {
                file.parts[0].push_back({"type", "string", type});
                file.parts[0].push_back({"name", "string", "part"});
                file.parts[0].push_back({"chunkCount", "int", reference::little({plain.table.size()}, 4)});
                expect_read_or_refused(file);
                file.parts[0].resize(file.parts[0].size() - 3);
            }
        }
    }
}

TEST(ExrFields, ChunksMayBeAnywhereAndSayAnything) {
    for (const ExrFile& plain : plain_files()) {
        for (const std::uint32_t value : kIntegers) {
            for (std::size_t k = 0; k < plain.table.size(); ++k) {
                ExrFile file = plain;
                file.table[k] = value;
                expect_read_or_refused(file);
                file.table[k] = std::uint64_t{value} << 32;
                expect_read_or_refused(file);
            }
            for (std::size_t at = 0; at < 20; at += 4) {
                ExrFile file = plain;
                file.chunks.replace(at, 4, reference::little({value}, 4));
                expect_read_or_refused(file);
            }
        }
        for (std::size_t size = 0; size < plain.chunks.size(); ++size) {
            ExrFile file = plain;
            file.chunks.resize(size);
            EXPECT_FALSE(expect_read_or_refused(file)) << size;
        }
    }
}

}  // namespace tex
