// SPDX-License-Identifier: Apache-2.0

#include "formats/hgt/hgt.h"

#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

namespace tex {
namespace {

Result<Image> read_hgt(std::size_t bytes, const std::string& name, FileValues values = FileValues::automatic) {
    std::vector<std::byte> heights(bytes);
    if (bytes > 4) {
        heights[0] = std::byte{0x22}, heights[1] = std::byte{0x98};  // Mount Everest: 8856 m
        heights[2] = std::byte{0xFE}, heights[3] = std::byte{0x50};  // the Dead Sea: -432 m
        heights[4] = std::byte{0x80};                                // no data
    }
    Result<InputFile> file = InputFile::from_memory(name, std::move(heights));
    if (!file) return file.error();
    ReadOptions options;
    options.values = values;
    return read_image(*file, options);
}

TEST(Hgt, HeightsAreMetres) {
    const auto image = read_hgt(2 * 1201 * 1201, "data/N27E086.HGT");
    ASSERT_TRUE(image) << image.error().message();
    EXPECT_EQ(image->extent(), (Extent{1201, 1201}));
    EXPECT_TRUE(image->stored);
    EXPECT_EQ(image->planes[0].at(0, 0), 8856.0f);
    EXPECT_EQ(image->planes[0].at(1, 0), -432.0f);
    EXPECT_EQ(image->planes[0].at(2, 0), -32768.0f);
    EXPECT_EQ(image->planes[0].at(1200, 1200), 0.0f);
    EXPECT_EQ(image->no_data, -32768.0f);
}

TEST(Hgt, FractionsHaveTheirNoDataToo) {
    const auto image = read_hgt(2 * 1201 * 1201, "x.hgt", FileValues::unit);
    ASSERT_TRUE(image) << image.error().message();
    EXPECT_EQ(image->planes[0].at(0, 0), 8856.0f / 32767.0f);
    EXPECT_EQ(image->planes[0].at(2, 0), -1.0f);
    EXPECT_EQ(image->no_data, -1.0f);
}

TEST(Hgt, TheLengthTellsTheExtent) {
    EXPECT_EQ(read_hgt(2 * 3601 * 3601, "x.hgt")->extent(), (Extent{3601, 3601}));
    EXPECT_EQ(read_hgt(2 * 1801 * 3601, "x.hgt")->extent(), (Extent{1801, 3601}));
    for (const std::size_t bytes : {1u, 2u * 1201 * 1201 - 1, 2u * 1201 * 1201 + 2}) {
        const auto image = read_hgt(bytes, "x.hgt");
        ASSERT_FALSE(image);
        EXPECT_EQ(image.error().code, ErrorCode::bad_data);
        EXPECT_EQ(image.error().reason,
                  std::to_string(bytes) +
                      " bytes are not an HGT file, which has 3601x3601, 1801x3601 or 1201x1201 heights; name another "
                      "extent in a raw layout, such as 7201x3601,s16be");
    }
}

}  // namespace
}  // namespace tex
