// SPDX-License-Identifier: Apache-2.0

#include "formats/asc/asc.h"

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "formats/words.h"

namespace tex {
namespace {

Result<Image> read_grid(std::string_view text) {
    const auto bytes = std::as_bytes(std::span(text.data(), text.size()));
    Result<InputFile> file = InputFile::from_memory("h.asc", {bytes.begin(), bytes.end()});
    if (!file) return file.error();
    return read_image(*file, {});
}

std::string reason_of(std::string_view text) {
    const auto image = read_grid(text);
    return image ? "read" : image.error().reason;
}

TEST(Asc, AGridOfAnotherProgramIsRead) {
    const std::string path = TEX_SOURCE_DIR "/../shared/data/wild/dem.asc";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "no ../shared/data/wild";
    const auto image = read_image(path);
    ASSERT_TRUE(image) << image.error().message();
    EXPECT_EQ(image->extent(), (Extent{48, 40}));
    // numpy.loadtxt(path, skiprows=5).astype(numpy.float32), and the sum of all in doubles.
    EXPECT_EQ(image->planes[0].at(0, 0), 0x1.3fe1eep-1f);
    EXPECT_EQ(image->planes[0].at(47, 39), 0x1.157066p-1f);
    EXPECT_EQ(image->planes[0].at(31, 17), 0x1.9afe74p-1f);
    double sum = 0.0;
    for (int j = 0; j < 40; ++j) {
        for (int i = 0; i < 48; ++i) sum += static_cast<double>(image->planes[0].at(i, j));
    }
    EXPECT_NEAR(sum, 0x1.e0785b6930000p+9, 1e-9);
}

TEST(Asc, TheHeaderComesInAnyOrderAndCase) {
    const auto image = read_grid(
        "NODATA_value -3.4028234663852886e+38\r\nCELLSIZE 30\r\nYLLCENTER 1e3\r\nxllCorner -5\r\nNRows 2\r\nnCols "
        "3.0\r\n1 +2 -3.5e-1\r\n\r\n4 -3.40282346638528860e+38\t.6");
    ASSERT_TRUE(image) << image.error().message();
    EXPECT_EQ(image->extent(), (Extent{3, 2}));
    EXPECT_EQ(image->names, std::vector<std::string>{"Y"});
    EXPECT_EQ(image->sample, SampleKind::floating);
    EXPECT_EQ(image->no_data, -std::numeric_limits<float>::max());
    EXPECT_EQ(image->remark, "");
    const float heights[] = {1.0f, 2.0f, -0.35f, 4.0f, -std::numeric_limits<float>::max(), 0.6f};
    for (int k = 0; k < 6; ++k) EXPECT_EQ(image->planes[0].at(k % 3, k / 3), heights[k]) << k;
}

TEST(Asc, NoDataIsThatOfArcGisIfTheFileNamesNone) {
    EXPECT_EQ(read_grid("ncols 1 nrows 1 cellsize 1 5")->no_data, -9999.0f);
    EXPECT_EQ(read_grid("\xEF\xBB\xBFncols 1 nrows 1 nodata_value 0 5")->no_data, 0.0f);
    EXPECT_TRUE(std::isnan(*read_grid("ncols 1 nrows 1 nodata_value nan 5")->no_data));
    EXPECT_TRUE(std::isnan(read_grid("ncols 2 nrows 1 5 NaN")->planes[0].at(1, 0)));
}

TEST(Asc, TheHeaderSaysWhereTheCellsAre) {
    const auto image = read_grid("ncols 2 nrows 3 xllcorner 500000 yllcenter 5000000 dx 2 dy 3 1 2 3 4 5 6");
    ASSERT_TRUE(image && image->ground);
    EXPECT_EQ(image->ground->width, 2.0);
    EXPECT_EQ(image->ground->height, 3.0);
    EXPECT_EQ(image->remark, "");
    const auto degrees = read_grid("ncols 1 nrows 5 xllcorner 7 yllcorner 46 cellsize 0.01 1 2 3 4 5");
    ASSERT_TRUE(degrees && degrees->ground);
    EXPECT_EQ(degrees->ground->unit, GroundUnit::degree);
    EXPECT_NEAR(degrees->ground->north, 46.045, 1e-12);
    EXPECT_FALSE(read_grid("ncols 1 nrows 1 5")->ground);
}

TEST(Asc, RefusesWhatIsDamagedAndNamesTheLine) {
    EXPECT_EQ(reason_of("nrows 2\n1 2\n"), "the header lacks ncols");
    EXPECT_EQ(reason_of("ncols 2\ncellsize 1\n1 2\n"), "the header lacks nrows");
    EXPECT_EQ(reason_of("ncols 2\nnrows 2\n1 2\n3"), "line 4: the file ends after 3 of 4 heights");
    EXPECT_EQ(reason_of("ncols 2\nnrows 1\n1 2\n3\n"), "line 4: \"3\" after the last height");
    EXPECT_EQ(reason_of("ncols 2\nnrows 1\n1 2,5\n"), "line 3: \"2,5\" is not a number");
    EXPECT_EQ(reason_of("ncols 2\nnrows two\n"), "line 2: \"two\" is not a number of nrows");
    EXPECT_EQ(reason_of("ncols 2\nnrows 1\nheight 3\n1 2\n"), "line 3: \"height\" is not a word of an ESRI ASCII grid");
    EXPECT_EQ(reason_of("ncols 2\nnrows 1\nncols 2\n1 2\n"), "line 3: ncols appears twice");
    EXPECT_EQ(reason_of("ncols 0\nnrows 1\n1 2\n"), "claims 0x1 texels");
    EXPECT_EQ(reason_of("ncols -3\nnrows nan\n1 2\n"), "claims 0x0 texels");
    EXPECT_EQ(reason_of("ncols 1.5\nnrows 1\n1 2\n"), "claims 0x1 texels");
    EXPECT_EQ(reason_of("ncols 1e300\nnrows 1\n1 2\n"), "1000000000x1 texels: a side is longer than 1048576");
    EXPECT_EQ(reason_of("ncols 20000\nnrows 20000\n1 2\n"),
              "claims 20000x20000 texels, more than its 28 bytes can hold");
    EXPECT_EQ(reason_of("ncols 1\nnrows 1\n" + std::string(500, '1')), "line 3: a word of more than 400 characters");
    EXPECT_EQ(reason_of("ncols 2 nrows 1 1 1e999"), "line 1: \"1e999\" is not a number");
    EXPECT_EQ(reason_of(std::string_view("ncols 2 nrows 1 1 \0", 19)), "line 1: \"?\" is not a number");
}

TEST(Asc, OtherTextIsNotAGrid) {
    for (const std::string_view text : {"ncols", "ncols two 3", "columns 3", "ncolsx 3", "", "1 2 3"})
        EXPECT_FALSE(may_be_asc(std::as_bytes(std::span(text.data(), text.size())))) << text;
    for (const std::string_view text : {"ncols 3", "\n NROWS\t\t12", "dx .5", "NODATA_value -1"})
        EXPECT_TRUE(may_be_asc(std::as_bytes(std::span(text.data(), text.size())))) << text;
}

TEST(Words, NumbersAreThoseOfEveryLocale) {
    EXPECT_EQ(number_in("+1.5E+2"), 150.0);
    EXPECT_EQ(number_in("-.5"), -0.5);
    for (const char* text : {"", "+", "+-1", "1,5", "1.5x", "0x10", "1e999", "--1"})
        EXPECT_FALSE(number_in(text)) << text;
    EXPECT_EQ(whole_number_in("12.0"), 12);
    EXPECT_FALSE(whole_number_in("12.5"));
    EXPECT_FALSE(whole_number_in("nan"));
    EXPECT_FALSE(whole_number_in("1e300"));
    constexpr float kMost = std::numeric_limits<float>::max();
    EXPECT_EQ(float_of(3.40282346638529e+38), kMost);  // as programs print it in 15 digits: above it
    EXPECT_EQ(float_of(-3.4028235e+38), -kMost);
    EXPECT_EQ(float_of(3.4028236e+38), std::numeric_limits<float>::infinity());
    EXPECT_EQ(float_of(-1.7976931348623157e308), -std::numeric_limits<float>::infinity());
}

}  // namespace
}  // namespace tex
