// SPDX-License-Identifier: Apache-2.0

#include "formats/exr/exr_dwa.h"

#include <gtest/gtest.h>

#include <cstring>

#include "formats/bytes.h"
#include "formats/exr/exr_rows.h"
#include "unit/exr_files.h"

namespace tex {
namespace {

using Bytes = std::vector<std::byte>;

const std::vector<std::string> kColors = {"A", "B", "G", "R"};
const std::vector<std::string> kChannels = {
    "A", "B", "G", "R", "Y", "depth", "two.B", "two.G", "two.R"};  // runs, cosine terms (three times), the rest

Result<Image> read_dwa(const Bytes& bytes) {
    Result<InputFile> opened = InputFile::from_memory("test.exr", bytes);
    return read_all(open_exr_rows(*opened, {}));
}

std::uint64_t load_u64(const Bytes& bytes, std::size_t at) {
    std::uint64_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

// The position of the head of the first chunk. It has version 2 and, after eleven numbers, the rules; the first rule is
// for a channel with this name.
std::size_t first_chunk(const Bytes& bytes) {
    for (std::size_t at = 0; at + 100 < bytes.size(); ++at) {
        if (load_u64(bytes, at) == 2 && load_u64(bytes, at + 80) <= 1 && bytes[at + 90] == std::byte{'R'}) return at;
    }
    return 0;
}

TEST(ExrDwa, SoundFilesAreWhole) {
    for (const Imf::Compression compression : {Imf::DWAA_COMPRESSION, Imf::DWAB_COMPRESSION}) {
        for (const Imf::PixelType type : {Imf::HALF, Imf::FLOAT, Imf::UINT}) {
            for (const bool tiled : {false, true}) {
                for (const Extent extent : {Extent{1, 1}, {8, 8}, {9, 33}, {37, 41}, {257, 70}, {64, 300}}) {
                    const auto image = read_dwa(exr_file(extent, kChannels, type, compression, tiled));
                    EXPECT_TRUE(image) << compression << type << tiled << " " << extent.width << "x" << extent.height
                                       << ": " << image.error().message();
                }
            }
        }
    }
}

TEST(ExrDwa, SoundColoursAndHeightsAreWhole) {
    const std::vector<std::string> sets[] = {
        kColors, {"Y"}, {"R", "G"}, {"layer.red", "layer.green", "layer.blue"}, {"depth"}};
    for (const std::vector<std::string>& names : sets) {
        for (const Imf::PixelType type : {Imf::HALF, Imf::FLOAT})
            EXPECT_TRUE(read_dwa(exr_file({70, 41}, names, type, Imf::DWAB_COMPRESSION))) << names[0];
    }
}

// OpenEXR reads all of these and takes the missing bytes from uninitialised memory.
TEST(ExrDwa, ShortBuffersAreDamage) {
    for (const std::vector<std::string>& names : {kChannels, kColors}) {
        const Bytes sound = exr_file({64, 32}, names, Imf::HALF, Imf::DWAA_COMPRESSION);
        const std::size_t head = first_chunk(sound);
        ASSERT_GT(head, 300u);
        ASSERT_TRUE(read_dwa(sound));
        enum : std::size_t {
            rest_bytes = 1,
            rest_packed,
            ac_packed,
            dc_packed,
            runs_packed,
            runs_bytes,
            runs_unrolled,
            ac_count,
            dc_count
        };
        const auto changed = [&](std::initializer_list<std::pair<std::size_t, std::uint64_t>> numbers) {
            Bytes bytes = sound;
            for (const auto& [number, value] : numbers)
                std::memcpy(bytes.data() + head + 8 * number, &value, sizeof value);
            return bytes;
        };
        const std::pair<const char*, Bytes> cases[] = {
            {"no runs", changed({{runs_unrolled, 0}})},
            {"nothing of the rest", changed({{rest_packed, 0}, {runs_packed, 0}, {runs_unrolled, 0}})},
            {"no DC", changed({{dc_packed, 0}, {dc_count, 0}})},
            {"no AC", changed({{ac_packed, 0}, {dc_packed, 0}, {dc_count, 0}})},
        };
        for (const auto& [name, bytes] : cases) {
            const auto image = read_dwa(bytes);
            ASSERT_FALSE(image) << name;
            EXPECT_EQ(image.error().code, ErrorCode::bad_data) << name;
        }
    }
}

}  // namespace
}  // namespace tex
