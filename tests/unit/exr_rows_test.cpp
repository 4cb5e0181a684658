// SPDX-License-Identifier: Apache-2.0

#include "formats/exr/exr_rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "formats/exr/exr.h"
#include "formats/exr/exr_chunk.h"
#include "formats/size_limits.h"
#include "reference/exr_file.h"
#include "unit/exr_files.h"

namespace tex {
namespace {

// Rows [first, first + count) from decode() and store(), which must write nothing outside these rows.
Image some_rows(RowSource& rows, int first, int count) {
    constexpr std::byte kGuard{0xa5};
    const std::size_t size = rows.row_bytes() * static_cast<std::size_t>((count + 3) / 4 * 4);
    std::vector<std::byte> decoded(size + 4096, kGuard);
    EXPECT_TRUE(rows.decode(first, count, decoded.data()));
    EXPECT_TRUE(std::all_of(decoded.begin() + static_cast<std::ptrdiff_t>(size), decoded.end(),
                            [](std::byte b) { return b == kGuard; }));
    Image image = make_image({rows.extent().width, count}, rows.names());
    rows.store(decoded.data(), 0, count, image);
    return image;
}

void expect_same(const Image& part, const Image& whole, int first) {
    for (std::size_t c = 0; c < whole.planes.size(); ++c) {
        for (int j = 0; j < part.extent().height; ++j) {
            const float* const row = part.planes[c].row(j);
            ASSERT_TRUE(std::equal(row, row + part.extent().width, whole.planes[c].row(first + j)))
                << c << " " << first << " + " << j;
        }
    }
}

// Chunks have 1 to 256 lines, and tiles have 8. Rows begin and end anywhere inside them.
TEST(ExrRows, AnyRowsAreThoseOfTheWholePicture) {
    std::minstd_rand random(3);
    for (int k = 0; k < Imf::NUM_COMPRESSION_METHODS; ++k) {
        for (const bool tiled : {false, true}) {
            for (const Imf::PixelType type : {Imf::HALF, Imf::FLOAT, Imf::UINT}) {
                SCOPED_TRACE(testing::Message()
                             << "compression " << k << (tiled ? ", tiles, type " : ", lines, type ") << type);
                const auto bytes =
                    exr_file({37, 41}, {"G", "R", "depth"}, type, static_cast<Imf::Compression>(k), tiled);
                Result<InputFile> file = InputFile::from_memory("rows.exr", bytes);
                const Result<Image> whole = read_all(open_exr_rows(*file, {}));
                ASSERT_TRUE(whole) << whole.error().message();
                const auto rows = open_exr_rows(*file, {});
                ASSERT_TRUE(rows) << rows.error().message();
                for (int round = 0; round < 12; ++round) {
                    const int first = static_cast<int>(random() % 41);
                    const int count = 1 + static_cast<int>(random() % static_cast<unsigned>(41 - first));
                    expect_same(some_rows(**rows, first, count), *whole, first);
                }
            }
        }
    }
}

// One file must not be whole for one thread and damaged for two.
TEST(ExrRows, ChunksAreWhereTheTableSaysInWhateverOrderTheyAreRead) {
    for (const Imf::Compression compression :
         {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION}) {
        SCOPED_TRACE(compression);
        const int chunks = (97 + chunk_lines(compression) - 1) / chunk_lines(compression);
        auto bytes = exr_file({5, 97}, {"G", "R"}, Imf::HALF, compression, false, Imf::INCREASING_Y);
        const auto entry = [&](std::size_t at) {
            std::uint64_t value = 0;
            std::memcpy(&value, bytes.data() + at, sizeof value);
            return value;
        };
        std::size_t table = 0;  // the chunks follow it
        while (entry(table) != table + sizeof(std::uint64_t) * static_cast<std::size_t>(chunks)) ++table;
        std::swap_ranges(bytes.begin() + static_cast<std::ptrdiff_t>(table + 8),
                         bytes.begin() + static_cast<std::ptrdiff_t>(table + 16),
                         bytes.begin() + static_cast<std::ptrdiff_t>(table + 16));
        Result<InputFile> file = InputFile::from_memory("table.exr", bytes);
        const Result<Image> whole = read_all(open_exr_rows(*file, {}));
        ASSERT_FALSE(whole);
        EXPECT_EQ(whole.error().code, ErrorCode::bad_data);
        const auto rows = open_exr_rows(*file, {});
        ASSERT_TRUE(rows);
        std::vector<std::byte> some((*rows)->row_bytes() * 4);
        EXPECT_FALSE((*rows)->decode(chunk_lines(compression), 1, some.data()));
    }
}

// A newer OpenEXR writes what ours cannot read: that is no damage.
TEST(ExrRows, UnknownCompressionsAreCalledSo) {
    constexpr std::string_view kAttribute("compression\0compression\0\1\0\0\0", 28);
    const auto bytes = exr_file({5, 7}, {"R"}, Imf::HALF, Imf::ZIP_COMPRESSION);
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::size_t at = text.find(kAttribute);
    ASSERT_NE(at, std::string::npos);
    for (const int code : {10, 11, 12, 255}) {
        if (code < Imf::NUM_COMPRESSION_METHODS) continue;
        auto newer = bytes;
        newer[at + kAttribute.size()] = static_cast<std::byte>(code);
        Result<InputFile> file = InputFile::from_memory("newer.exr", newer);
        const auto rows = open_exr_rows(*file, {});
        ASSERT_FALSE(rows);
        EXPECT_EQ(rows.error().code, ErrorCode::unsupported);
        const std::string what = code < 12 ? "compressed with HTJ2K" : "an unknown compression, number ";
        EXPECT_EQ(rows.error().reason.rfind(what, 0), 0u) << rows.error().reason;
    }
}

// OpenEXR does not look at the attribute `tiles` in a part of scan lines, so it may have any value. Some writers leave
// it behind when they convert a tiled file.
TEST(ExrRows, ScanLinesIgnoreALeftoverTileDescription) {
    const auto plain = exr_file({37, 41}, {"B", "G", "R"}, Imf::HALF, Imf::ZIP_COMPRESSION);
    Result<InputFile> plain_file = InputFile::from_memory("lines.exr", plain);
    const Result<Image> whole = read_all(open_exr_rows(*plain_file, {}));
    ASSERT_TRUE(whole);
    const auto parsed = reference::parse_exr({reinterpret_cast<const char*>(plain.data()), plain.size()});
    ASSERT_TRUE(parsed);
    for (const std::uint32_t size : {0u, 1u, 64u, 0x7fffffffu, 0xffffffffu}) {
        for (const char mode : {'\0', '\1', '\2', '\x11', '\x7f'}) {
            SCOPED_TRACE(testing::Message() << size << " mode " << int{mode});
            auto with_tiles = parsed;
            with_tiles->parts[0].push_back({"tiles", "tiledesc", reference::exr_tiles(64, size, mode)});
            const std::string text = reference::write_exr(*with_tiles);
            const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
            Result<InputFile> file = InputFile::from_memory("tiles.exr", {bytes, bytes + text.size()});
            const Result<Image> image = read_all(open_exr_rows(*file, {}));
            ASSERT_TRUE(image) << image.error().message();
            expect_same(*image, *whole, 0);
            const auto rows = open_exr_rows(*file, {});
            ASSERT_TRUE(rows);
            EXPECT_EQ((*rows)->rows_together(), 16);
            expect_same(some_rows(**rows, 3, 20), *whole, 3);
            const auto texture = open_exr_texture_rows(*file, {});
            ASSERT_TRUE(texture) << texture.error().message();
            EXPECT_EQ(texture->levels.size(), 1u);
        }
    }
}

TEST(ExrRows, PlanesThatNobodyWantsStayAsTheyWere) {
    Result<InputFile> file =
        InputFile::from_memory("rows.exr", exr_file({5, 4}, {"G", "R"}, Imf::FLOAT, Imf::ZIP_COMPRESSION, false));
    const auto rows = open_exr_rows(*file, {});
    ASSERT_TRUE(rows);
    (*rows)->choose_planes({false, true});
    std::vector<std::byte> decoded((*rows)->row_bytes() * 4);
    ASSERT_TRUE((*rows)->decode(0, 4, decoded.data()));
    Image image = make_image({5, 4}, (*rows)->names());
    std::fill_n(image.planes[0].row(1), 5, 7.0f);
    (*rows)->store(decoded.data(), 0, 4, image);
    EXPECT_EQ(image.planes[0].at(3, 1), 7.0f);
    EXPECT_EQ(image.planes[1].at(3, 1), exr_value(3, 1, 0));
}

}  // namespace
}  // namespace tex
