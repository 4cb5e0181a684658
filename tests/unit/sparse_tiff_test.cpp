// SPDX-License-Identifier: Apache-2.0
// TIFF files as GDAL writes them: strips that were never written (SPARSE_OK=TRUE), a mask
// (GDAL_TIFF_INTERNAL_MASK=YES). What is expected of them is what gdal_translate and GDALDataset::ReadAsArray of
// GDAL 3.6.2 give.

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tex/file.h>
#include <tex/height.h>
#include <unistd.h>

#include "scratch.h"

namespace tex {
namespace {

// A TIFF of strips of one row. Strips without bytes are absent.
struct Strips {
    int width = 4, channels = 1, bits = 8, sample_format = 1;
    bool is_planar = false, has_white_zero = false, is_georeferenced = false, has_alpha = false;
    std::string no_data;
    std::vector<std::string> strips;
    std::vector<std::string> mask;  // a row each, of bits

    [[nodiscard]] std::string bytes() const {
        std::string out("II*\0\0\0\0\0", 8);
        const auto at = add_picture(out, strips, bits, channels, 0);
        std::memcpy(&out[4], &at.first, 4);
        if (!mask.empty()) {
            const auto second = add_picture(out, mask, 1, 1, 4);
            std::memcpy(&out[at.second], &second.first, 4);
        }
        return out;
    }

private:
    static void put(std::string& to, std::uint32_t value, int count) {
        for (int k = 0; k < count; ++k) to.push_back(static_cast<char>(value >> 8 * k));
    }
    static std::uint32_t place(const std::string& out) { return static_cast<std::uint32_t>(out.size()); }
    static std::uint32_t list(std::string& out, const std::vector<std::uint32_t>& values, int bytes) {
        if (out.size() % 2 == 1) out.push_back('\0');
        const std::uint32_t at = place(out);
        for (const std::uint32_t value : values) put(out, value, bytes);
        return at;
    }

    // Adds a picture; returns the places of its directory and of the offset of the next one.
    std::pair<std::uint32_t, std::uint32_t> add_picture(std::string& out, const std::vector<std::string>& rows,
                                                        int depth, int samples, std::uint32_t kind) const {
        std::vector<std::uint32_t> offsets, counts;
        for (const std::string& row : rows) {
            offsets.push_back(row.empty() ? 0 : place(out));
            counts.push_back(static_cast<std::uint32_t>(row.size()));
            out += row;
        }
        const auto n = static_cast<std::uint32_t>(rows.size()), s = static_cast<std::uint32_t>(samples);
        const std::uint32_t height = n / (is_planar && kind == 0 ? s : 1);
        struct Tag {
            std::uint32_t id, type, count, value;
        };
        std::vector<Tag> tags = {
            {254, 4, 1, kind}, {256, 4, 1, static_cast<std::uint32_t>(width)}, {257, 4, 1, height}};
        const auto all = [&](std::uint32_t value) { return std::vector<std::uint32_t>(s, value); };
        const auto shorts = [&](std::uint32_t id, std::uint32_t value) {
            tags.push_back({id, 3, s, s == 1 ? value : s == 2 ? value << 16 | value : list(out, all(value), 2)});
        };
        const auto longs = [&](std::uint32_t id, const std::vector<std::uint32_t>& values) {
            tags.push_back({id, 4, n, n == 1 ? values[0] : list(out, values, 4)});
        };
        shorts(258, static_cast<std::uint32_t>(depth));
        tags.push_back({259, 3, 1, 1});
        tags.push_back({262, 3, 1, kind == 4 ? 4u : has_white_zero ? 0u : samples >= 3 ? 2u : 1u});
        longs(273, offsets);
        tags.push_back({277, 3, 1, s});
        tags.push_back({278, 4, 1, 1});
        longs(279, counts);
        tags.push_back({284, 3, 1, is_planar && kind == 0 ? 2u : 1u});
        if (has_alpha && kind == 0) tags.push_back({338, 3, 1, 2});
        shorts(339, kind == 0 ? static_cast<std::uint32_t>(sample_format) : 1);
        if (is_georeferenced && kind == 0) {
            std::uint64_t one;
            const double size = 1.0;
            std::memcpy(&one, &size, 8);
            const std::vector<std::uint32_t> words = {
                0, static_cast<std::uint32_t>(one >> 32), 0, static_cast<std::uint32_t>(one >> 32), 0, 0};
            tags.push_back({33550, 12, 3, list(out, words, 4)});
        }
        if (!no_data.empty() && kind == 0) {
            std::string text = no_data;
            text.resize(text.size() + 5);  // beyond the four bytes that lie in the tag itself
            tags.push_back({42113, 2, static_cast<std::uint32_t>(text.size()), place(out)});
            out += text;
        }
        if (out.size() % 2 == 1) out.push_back('\0');
        const std::uint32_t directory = place(out);
        put(out, static_cast<std::uint32_t>(tags.size()), 2);
        for (const Tag& tag : tags)
            put(out, tag.id, 2), put(out, tag.type, 2), put(out, tag.count, 4), put(out, tag.value, 4);
        put(out, 0, 4);
        return {directory, place(out) - 4};
    }
};

std::string floats(std::initializer_list<float> values) {
    return {reinterpret_cast<const char*>(values.begin()), values.size() * sizeof(float)};
}

class SparseTiff : public testing::Test, protected Scratch {
protected:
    Result<Image> read(const Strips& tiff) { return read_image(write("a.tif", tiff.bytes())); }
};

TEST_F(SparseTiff, AbsentStripsAreZeroAndCounted) {
    Strips tiff;
    tiff.strips = {"", std::string("\1\2\3\4", 4), "", ""};
    const auto image = read(tiff);
    ASSERT_TRUE(image) << image.error().message();
    for (const int j : {0, 2, 3}) {
        for (int i = 0; i < 4; ++i) EXPECT_EQ(image->planes[0].at(i, j), 0.0f) << i << " " << j;
    }
    EXPECT_EQ(image->planes[0].at(3, 1), 4.0f / 255.0f);
    EXPECT_EQ(
        image->remark,
        "3 of 4 strips were never written; the texels there are read as 0, because the file has no no-data value");
    tiff.no_data = "-9999";  // no sample has this value: GDAL reads 0, too
    EXPECT_EQ(read(tiff)->planes[0].at(0, 0), 0.0f);
    tiff.strips = {""};
    tiff.no_data = {};
    EXPECT_EQ(read(tiff)->remark.substr(0, 32), "1 of 1 strip was never written; ");
}

TEST_F(SparseTiff, AbsentStripsAreNoDataIfTheFileNamesAValue) {
    Strips tiff;
    tiff.bits = 32;
    tiff.sample_format = 3;
    tiff.no_data = "-9999";
    tiff.strips = {floats({1, 2, 3, 4}), "", floats({5, 6, 7, 8})};
    const auto image = read(tiff);
    ASSERT_TRUE(image) << image.error().message();
    EXPECT_EQ(image->planes[0].at(0, 1), -9999.0f);
    EXPECT_EQ(image->no_data, -9999.0f);
    EXPECT_EQ(image->remark, "1 of 3 strips was never written; the texels there have the no-data value of the file");
    EXPECT_EQ(height_field(*image).error().reason,
              "4 heights are NaN, infinite or no-data, the first at column 0, row 1");

    Strips integers;
    integers.bits = 16;
    integers.sample_format = 2;
    integers.no_data = "-32768";
    integers.strips = {std::string(8, '\1'), ""};
    const auto whole = read(integers);
    ASSERT_TRUE(whole) << whole.error().message();
    EXPECT_EQ(whole->planes[0].at(2, 1), *whole->no_data);
}

TEST_F(SparseTiff, ColoursAndPlanesAreReadLikewise) {
    Strips tiff;
    tiff.channels = 3;
    tiff.strips = {std::string(12, '\x40'), ""};
    auto image = read(tiff);
    ASSERT_TRUE(image) << image.error().message();
    EXPECT_EQ(image->planes[2].at(3, 0), 64.0f / 255.0f);
    EXPECT_EQ(image->planes[2].at(3, 1), 0.0f);
    tiff.no_data = "7";
    EXPECT_EQ(read(tiff)->planes[1].at(0, 1), 7.0f / 255.0f);
    tiff.is_planar = true;
    tiff.strips = {std::string(4, '\1'), std::string(4, '\2'), "", std::string(4, '\3'), std::string(4, '\4'), ""};
    image = read(tiff);
    ASSERT_TRUE(image) << image.error().message();
    const float codes[3][2] = {{1, 2}, {7, 3}, {4, 7}};
    for (int c = 0; c < 3; ++c) {
        for (int j = 0; j < 2; ++j)
            EXPECT_EQ(image->planes[static_cast<std::size_t>(c)].at(1, j), codes[c][j] / 255.0f) << c << j;
    }
    const auto texture = read_texture(path("a.tif"));
    ASSERT_TRUE(texture) << texture.error().message();
    ASSERT_EQ(texture->remarks.size(), 1u);
    EXPECT_EQ(texture->remarks[0].substr(0, 32), "2 of 6 strips were never written");
}

// The value is a code of the file, whose white is 0.
TEST_F(SparseTiff, TheNoDataValueOfAnInvertedPictureIsInverted) {
    Strips tiff;
    tiff.has_white_zero = true;
    tiff.no_data = "255";
    tiff.strips = {std::string("\xff\1\2\3", 4)};
    const auto image = read(tiff);
    ASSERT_TRUE(image) << image.error().message();
    EXPECT_EQ(image->planes[0].at(0, 0), 0.0f);
    EXPECT_EQ(image->no_data, 0.0f);
}

// GDAL's mask band is 255 where the bit is 1, and 0 elsewhere.
TEST_F(SparseTiff, TexelsThatAMaskLeavesOutHaveNoHeight) {
    Strips tiff;
    tiff.strips = {std::string("\1\2\3\4", 4), std::string("\5\6\7\10", 4)};
    tiff.mask = {"\xf0", std::string("\xb0", 1)};
    const auto image = read(tiff);
    ASSERT_TRUE(image) << image.error().message();
    EXPECT_EQ(image->names, std::vector<std::string>{"Y"});
    EXPECT_EQ(image->planes[0].at(0, 1), 5.0f / 255.0f);
    EXPECT_TRUE(std::isnan(image->planes[0].at(1, 1)));
    EXPECT_EQ(image->planes[0].at(2, 1), 7.0f / 255.0f);
    tiff.mask = {"\xf0", ""};  // an absent strip of a mask is 0
    EXPECT_TRUE(std::isnan(read(tiff)->planes[0].at(3, 1)));
    // Vectors stay as they are stored.
    const auto texture = read_texture(path("a.tif"));
    ASSERT_TRUE(texture);
    EXPECT_EQ(texture->levels[0].bytes[5], std::byte{6});
}

TEST_F(SparseTiff, AnAlphaOfZeroIsNoDataOnlyOnTheEarth) {
    Strips tiff;
    tiff.channels = 2;
    tiff.has_alpha = true;
    tiff.strips = {std::string("\1\xff\2\0\3\xff\4\xff", 8)};
    EXPECT_EQ(read(tiff)->planes[0].at(1, 0), 2.0f / 255.0f);
    tiff.is_georeferenced = true;
    const auto image = read(tiff);
    ASSERT_TRUE(image) << image.error().message();
    EXPECT_TRUE(std::isnan(image->planes[0].at(1, 0)));
    EXPECT_EQ(image->planes[1].at(1, 0), 0.0f);
    EXPECT_FALSE(std::isnan(image->planes[0].at(0, 0)));
}

}  // namespace
}  // namespace tex
