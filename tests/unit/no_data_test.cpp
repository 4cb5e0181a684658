// SPDX-License-Identifier: Apache-2.0
// The value that a TIFF names for texels without data (GDAL's tag), in files that are written here.

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/file.h>
#include <tex/height.h>
#include <unistd.h>

#include "scratch.h"

namespace tex {
namespace {

enum class Sample { u8, u16, s16, f32 };

// A TIFF of one strip and one channel, 4x2 texels, uncompressed.
struct Tiff {
    Sample sample = Sample::f32;
    std::vector<double> values = {1, 2, -9999, 4, 5, 6, 7, 8};
    std::string text = "-9999";  // of the tag, with a zero behind it
    bool big_endian = false;
    bool big_tiff = false;
    std::uint16_t text_type = 2;    // ASCII
    std::uint64_t text_offset = 0;  // 0: where the text is
    std::uint64_t text_count = 0;   // 0: that of the text
    bool has_tag = true;

    [[nodiscard]] std::string bytes() const {
        const int sample_bytes = sample == Sample::u8 ? 1 : sample == Sample::f32 ? 4 : 2;
        std::string data;
        for (const double value : values) {
            if (sample == Sample::f32) {
                const auto number = static_cast<float>(value);
                std::uint32_t bits = 0;
                std::memcpy(&bits, &number, sizeof bits);
                put(data, bits, 4);
            } else {
                put(data, static_cast<std::uint64_t>(static_cast<std::int64_t>(value)), sample_bytes);
            }
        }
        std::string tag = text;
        tag.push_back('\0');
        const int word = big_tiff ? 8 : 4;
        const std::uint64_t head = big_tiff ? 16 : 8;
        const std::uint64_t at_tag = head + data.size();
        std::string out(big_endian ? "MM" : "II");
        put(out, big_tiff ? 43 : 42, 2);
        if (big_tiff) put(out, 8, 2), put(out, 0, 2);
        put(out, at_tag + tag.size() + tag.size() % 2, word);
        out += data + tag;
        if (tag.size() % 2 == 1) out.push_back('\0');
        put(out, has_tag ? 11 : 10, big_tiff ? 8 : 2);
        const auto entry = [&](int id, int type, std::uint64_t value) {
            put(out, static_cast<std::uint64_t>(id), 2);
            put(out, static_cast<std::uint64_t>(type), 2);
            put(out, 1, word);
            const int size = type == 3 ? 2 : 4;
            put(out, value, size);
            out.append(static_cast<std::size_t>(word - size), '\0');
        };
        entry(256, 4, 4), entry(257, 4, 2);
        entry(258, 3, static_cast<std::uint64_t>(8 * sample_bytes));
        entry(259, 3, 1), entry(262, 3, 1);
        entry(273, 4, head), entry(277, 3, 1), entry(278, 4, 2), entry(279, 4, data.size());
        entry(339, 3, sample == Sample::f32 ? 3 : sample == Sample::s16 ? 2 : 1);
        if (has_tag) {
            put(out, 42113, 2), put(out, text_type, 2);
            put(out, text_count != 0 ? text_count : tag.size(), word);
            if (tag.size() <= static_cast<std::size_t>(word) && text_offset == 0) {
                out += tag + std::string(static_cast<std::size_t>(word) - tag.size(), '\0');
            } else {
                put(out, text_offset != 0 ? text_offset : at_tag, word);
            }
        }
        put(out, 0, word);
        return out;
    }

private:
    void put(std::string& to, std::uint64_t value, int count) const {
        for (int k = 0; k < count; ++k) to.push_back(static_cast<char>(value >> 8 * (big_endian ? count - 1 - k : k)));
    }
};

class NoData : public testing::Test, protected Scratch {
protected:
    Result<Image> read(const Tiff& tiff) { return read_image(write("a.tif", tiff.bytes())); }
};

TEST_F(NoData, IsReadFromEveryFormOfTiff) {
    for (const bool big_endian : {false, true}) {
        for (const bool big_tiff : {false, true}) {
            for (const char* text : {"-9999", " -9999 ", "-9999.0", "-9.999e3"}) {
                Tiff tiff;
                tiff.big_endian = big_endian;
                tiff.big_tiff = big_tiff;
                tiff.text = text;
                const auto image = read(tiff);
                ASSERT_TRUE(image) << image.error().message();
                EXPECT_EQ(image->planes[0].at(2, 0), -9999.0f);
                EXPECT_EQ(image->no_data, -9999.0f) << text << big_endian << big_tiff;
            }
        }
    }
    Tiff tiff;
    tiff.text = "-1";  // short enough to lie in the entry
    tiff.values[2] = -1;
    EXPECT_EQ(read(tiff)->no_data, -1.0f);
    tiff.text = "-3.40282346638529e+38";  // GDAL rounds the smallest float beyond it
    EXPECT_EQ(read(tiff)->no_data, -3.40282346638528859e+38f);
}

TEST_F(NoData, IsInUnitsOfThePicture) {
    Tiff tiff;
    tiff.sample = Sample::u16;
    tiff.values[2] = 65535;
    tiff.text = "65535";
    EXPECT_EQ(read(tiff)->no_data, 1.0f);
    tiff.text = "65536";  // no sample has this value
    EXPECT_FALSE(read(tiff)->no_data);
    tiff.text = "0.5";
    EXPECT_FALSE(read(tiff)->no_data);
    tiff.sample = Sample::s16;
    tiff.values[2] = -9999;
    tiff.text = "-9999";
    auto image = read(tiff);
    EXPECT_EQ(image->no_data, image->planes[0].at(2, 0));
    tiff.values[2] = -32768;
    tiff.text = "-32768";
    image = read(tiff);
    EXPECT_EQ(image->no_data, image->planes[0].at(2, 0));
    tiff.sample = Sample::u8;
    tiff.values[2] = 255;
    tiff.text = "255";
    EXPECT_EQ(read(tiff)->no_data, 1.0f);
}

TEST_F(NoData, IsIgnoredIfTheTagMakesNoSense) {
    std::vector<Tiff> files(8);
    files[0].has_tag = false;
    files[1].text_type = 4;
    files[2].text_offset = 1'000'000;
    files[3].text_count = 0xFFFFFFFF;
    files[4].text = "nan";
    files[5].text = "none";
    files[6].text = "-9999 metres";
    files[7].text = "";
    for (const Tiff& tiff : files) {
        const auto image = read(tiff);
        // libtiff may refuse a damaged tag.
        if (image) {
            EXPECT_FALSE(image->no_data) << &tiff - files.data();
        }
    }
    EXPECT_TRUE(read(files[0]));
    EXPECT_TRUE(read(files[5]));
}

TEST_F(NoData, MakesHeightsInvalidUnlessTheOptionsSayOtherwise) {
    const Image image = read({}).value();
    HeightOptions options;
    const auto refused = height_field(image, options);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().reason, "1 height is NaN, infinite or no-data, the first at column 2, row 0");
    EXPECT_EQ(refused.error().detail, ErrorDetail::missing_heights);
    options.fill_invalid = true;
    const auto filled = height_field(image, options);
    ASSERT_TRUE(filled);
    EXPECT_EQ(filled->report.invalid_texels, 1);
    EXPECT_GT(filled->height.at(2, 0), 0.0f);
    options = {};
    options.no_data = 4.0f;  // another value replaces that of the file
    EXPECT_EQ(height_field(image, options).error().reason,
              "1 height is NaN, infinite or no-data, the first at column 3, row 0");
    options.no_data = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(height_field(image, options).value().height.at(2, 0), -9999.0f);
}

}  // namespace
}  // namespace tex
