// SPDX-License-Identifier: Apache-2.0

#include "formats/bmp/bmp.h"

#include <gtest/gtest.h>

#include <array>

#include <tex/file.h>

#include "formats/file_types.h"
#include "reference/bmp_file.h"

namespace tex {
namespace {

using reference::BmpFile;
using reference::FileBytes;

std::uint32_t noise(int i, int j) { return (static_cast<std::uint32_t>(i / 2 + j * 3) * 2654435761u) ^ 0x5a5a5a5a; }

Result<Image> read_bmp(const FileBytes& bytes) {
    Result<InputFile> file = InputFile::from_memory("a.bmp", bytes);
    return file ? read_image(*file, {}) : Result<Image>(file.error());
}

std::string refusal_of(const FileBytes& bytes) {
    const Result<Image> image = read_bmp(bytes);
    return image ? "none" : image.error().reason;
}

// Values of the channels.
using Values = std::array<double, 4>;
using ValuesAt = std::function<Values(int i, int j)>;

void expect_values(const FileBytes& bytes, const std::vector<std::string>& names, int bits, const ValuesAt& expected) {
    const Result<Image> image = read_bmp(bytes);
    ASSERT_TRUE(image) << image.error().message();
    EXPECT_EQ(image->names, names);
    EXPECT_EQ(image->bits, bits);
    for (int j = 0; j < image->extent().height; ++j) {
        for (int i = 0; i < image->extent().width; ++i) {
            const Values values = expected(i, j);
            for (std::size_t c = 0; c < names.size(); ++c)
                ASSERT_EQ(image->planes[c].at(i, j), static_cast<float>(values[c])) << i << "," << j << " " << c;
        }
    }
}

const std::vector<std::string> kY{"Y"}, kRgb{"R", "G", "B"}, kRgbWithA{"R", "G", "B", "A"};

Values bytes_of_color(std::uint32_t color) {
    return {(color >> 16 & 255) / 255.0, (color >> 8 & 255) / 255.0, (color & 255) / 255.0, (color >> 24) / 255.0};
}

TEST(Bmp, ReadsPalettesOfEveryDepthAndHeader) {
    for (const int depth : {1, 2, 4, 8}) {
        for (const std::uint32_t header : {12u, 40u, 52u, 56u, 64u, 108u, 124u}) {
            for (const bool from_top : {false, true}) {
                if (from_top && header == 12) continue;
                SCOPED_TRACE(testing::Message() << depth << " bits, header " << header << (from_top ? " top" : ""));
                const std::uint32_t colors = 1u << depth;
                BmpFile file;
                file.width = 11;
                file.depth = depth;
                file.header = header;
                file.from_top = from_top;
                file.gap = depth == 8 ? 6 : 0;
                for (std::uint32_t k = 0; k < colors; ++k)
                    file.palette.push_back(noise(static_cast<int>(2 * k), 1) & 0xffffff);
                file.texel = [colors](int i, int j) { return noise(i, j) % colors; };
                expect_values(file.make(), kRgb, 8,
                              [&](int i, int j) { return bytes_of_color(file.palette[file.texel(i, j)]); });
            }
        }
    }
}

TEST(Bmp, AGreyPaletteIsGrey) {
    BmpFile file;
    file.depth = 4;
    file.colors = 3;
    file.palette = {0x101010, 0xffffff, 0x707070};
    file.texel = [](int i, int j) { return static_cast<std::uint32_t>((i + j) % 3); };
    expect_values(file.make(), kY, 8, [&](int i, int j) { return bytes_of_color(file.palette[file.texel(i, j)]); });
    file.texel = [](int, int) { return 3u; };
    EXPECT_EQ(refusal_of(file.make()), "damaged: a texel has a colour that the palette lacks");
}

TEST(Bmp, Reads24And32BitsWithoutMasks) {
    for (const int depth : {24, 32}) {
        for (const std::uint32_t header : {12u, 40u, 108u}) {
            BmpFile file;
            file.depth = depth;
            file.header = header;
            file.from_top = header == 108;
            file.texel = noise;
            // The masks of a header that does not announce them mean nothing, and neither does the fourth byte.
            if (header == 108) file.masks = {0xff, 0xff00, 0xff0000, 0xff000000};
            expect_values(file.make(), kRgb, 8, [&](int i, int j) { return bytes_of_color(file.texel(i, j)); });
        }
    }
}

struct Masks {
    std::vector<std::uint32_t> masks;
    int depth;
    int bits;  // of the samples that come out
};

TEST(Bmp, ReadsMasks) {
    const Masks cases[] = {
        {{0x7c00, 0x3e0, 0x1f}, 16, 5},
        {{0x7c00, 0x3e0, 0x1f, 0x8000}, 16, 5},
        {{0xf000, 0xf00, 0xf0, 0xf}, 16, 4},
        {{0xff0000, 0xff00, 0xff}, 32, 8},
        {{0xff, 0xff00, 0xff0000, 0xff000000}, 32, 8},
        {{0x3ff00000, 0xffc00, 0x3ff, 0xc0000000}, 32, 10},
        {{0xff000000, 0xff0000, 0xff00}, 32, 8},
    };
    for (const Masks& one : cases) {
        for (const std::uint32_t header : {40u, 56u, 108u, 124u}) {
            BmpFile file;
            file.depth = one.depth;
            file.masks = one.masks;
            file.header = header;
            file.compression = header == 40 && one.masks.size() == 4 ? 6 : 3;
            file.texel = noise;
            SCOPED_TRACE(testing::Message() << "masks " << one.masks[0] << " header " << header);
            expect_values(file.make(), one.masks.size() == 4 ? kRgbWithA : kRgb, one.bits, [&](int i, int j) {
                Values values{};
                for (std::size_t c = 0; c < one.masks.size(); ++c) {
                    const std::uint32_t mask = one.masks[c];
                    const std::uint32_t stored = file.texel(i, j) & (one.depth == 16 ? 0xffffu : ~0u) & mask;
                    values[c] = static_cast<double>(stored) / mask;
                }
                return values;
            });
        }
    }
}

// Their bits repeated, as OpenImageIO widens them.
TEST(Bmp, MasksOfUnequalSizeBecome8Or16Bits) {
    BmpFile file;
    file.depth = 16;
    file.compression = 3;
    file.masks = {0xf800, 0x7e0, 0x1f};
    file.texel = noise;
    expect_values(file.make(), kRgb, 8, [&](int i, int j) {
        const std::uint32_t r = file.texel(i, j) >> 11 & 31, g = file.texel(i, j) >> 5 & 63, b = file.texel(i, j) & 31;
        return Values{(r << 3 | r >> 2) / 255.0, (g << 2 | g >> 4) / 255.0, (b << 3 | b >> 2) / 255.0, 0.0};
    });
    file.depth = 32;
    file.masks = {0xffe00000, 0x1ffc00, 0x3ff};
    expect_values(file.make(), kRgb, 16, [&](int i, int j) {
        const std::uint32_t r = file.texel(i, j) >> 21, g = file.texel(i, j) >> 10 & 2047, b = file.texel(i, j) & 1023;
        return Values{(r << 5 | r >> 6) / 65535.0, (g << 5 | g >> 6) / 65535.0, (b << 6 | b >> 4) / 65535.0, 0.0};
    });
    file.masks = {0xfffff000, 0xf00, 0xf0};  // 20 bits: the upper 16 count
    expect_values(file.make(), kRgb, 16, [&](int i, int j) {
        const std::uint32_t t = file.texel(i, j);
        return Values{(t >> 16) / 65535.0, (t >> 8 & 15) / 15.0, (t >> 4 & 15) / 15.0, 0.0};
    });
}

TEST(Bmp, Reads16BitsWithoutMasks) {
    BmpFile file;
    file.depth = 16;
    file.texel = noise;
    expect_values(file.make(), kRgb, 5, [&](int i, int j) {
        const std::uint32_t t = file.texel(i, j);
        return Values{(t >> 10 & 31) / 31.0, (t >> 5 & 31) / 31.0, (t & 31) / 31.0, 0.0};
    });
}

BmpFile rle_of(int depth, int width, int height) {
    BmpFile file;
    file.width = width;
    file.height = height;
    file.depth = depth;
    file.compression = depth == 8 ? 1 : 2;
    for (std::uint32_t k = 0; k < (1u << depth); ++k) file.palette.push_back(k << 16 | (255 - k));
    file.texel = [depth](int i, int j) { return noise(i / 3, j) % (1u << depth); };
    return file;
}

TEST(Bmp, ReadsRle) {
    for (const int depth : {4, 8}) {
        for (const int width : {1, 2, 7, 300, 600}) {
            SCOPED_TRACE(testing::Message() << "RLE" << depth << ", width " << width);
            const BmpFile file = rle_of(depth, width, 5);
            expect_values(file.make(), kRgb, 8,
                          [&](int i, int j) { return bytes_of_color(file.palette[file.texel(i, j)]); });
        }
    }
}

// The texels of a file of 6 x 4 with these codes, rows from the top.
std::vector<std::string> rle8_rows(std::initializer_list<int> codes) {
    BmpFile file = rle_of(8, 6, 4);
    file.height = 0;
    FileBytes bytes = file.make();
    bytes[22] = std::byte{4};
    for (const int code : codes) bytes.push_back(static_cast<std::byte>(code));
    const Result<Image> image = read_bmp(bytes);
    if (!image) return {image.error().reason};
    std::vector<std::string> rows;
    for (int j = 0; j < 4; ++j) {
        rows.emplace_back();
        for (int i = 0; i < 6; ++i)
            rows.back() += static_cast<char>('0' + static_cast<int>(image->planes[0].at(i, j) * 255.0f + 0.5f));
    }
    return rows;
}

TEST(Bmp, CodesOfRleSkipTexelsAndRows) {
    using Rows = std::vector<std::string>;
    EXPECT_EQ(rle8_rows({2, 1, 0, 0, 3, 2, 0, 2, 1, 2, 1, 4, 0, 1}), (Rows{"000040", "000000", "222000", "110000"}));
    EXPECT_EQ(rle8_rows({1, 1, 0, 2, 2, 0, 1, 5, 0, 1}), (Rows{"000000", "000000", "000000", "100500"}));
    EXPECT_EQ(rle8_rows({0, 2, 0, 3, 9, 7, 0, 0}), (Rows{"777777", "000000", "000000", "000000"}));
    EXPECT_EQ(rle8_rows({6, 1, 0, 2, 255, 255, 1, 1}), (Rows{"000000", "000000", "000000", "111111"}));
    EXPECT_EQ(rle8_rows({0, 3, 1, 2, 3, 0, 0, 1}), (Rows{"000000", "000000", "000000", "123000"}));
    EXPECT_EQ(rle8_rows({0, 1}), (Rows{"000000", "000000", "000000", "000000"}));
    const Rows ends{"damaged: the file ends before its last row"};
    EXPECT_EQ(rle8_rows({}), ends);
    EXPECT_EQ(rle8_rows({6, 1}), ends);
    EXPECT_EQ(rle8_rows({0, 6, 1, 2, 3}), ends);
    EXPECT_EQ(rle8_rows({6, 1, 0, 2, 1}), ends);
}

TEST(Bmp, TruncatedFilesAreDamaged) {
    BmpFile file;
    file.texel = noise;
    const FileBytes plain = file.make();
    const FileBytes packed = rle_of(4, 9, 4).make();
    for (const FileBytes& whole : {plain, packed}) {
        // The last row need not be filled up to a multiple of four bytes.
        const std::size_t padding = whole == plain ? 1 : 0;
        for (std::size_t size = 2; size < whole.size() - padding; ++size) {
            const Result<Image> image = read_bmp({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)});
            ASSERT_FALSE(image) << size;
            EXPECT_EQ(image.error().code, ErrorCode::bad_data) << size << image.error().reason;
        }
        EXPECT_EQ(refusal_of({whole.begin(), whole.end() - static_cast<std::ptrdiff_t>(padding)}), "none");
    }
}

TEST(Bmp, SaysWhatIsWrong) {
    const auto with = [](int depth, std::uint32_t compression, std::uint32_t header = 40) {
        BmpFile file;
        file.depth = depth;
        file.compression = compression;
        file.header = header;
        file.texel = noise;
        file.palette.resize(16);
        return refusal_of(file.make());
    };
    EXPECT_EQ(with(24, 4), "a JPEG in a BMP");
    EXPECT_EQ(with(24, 5), "a PNG in a BMP");
    EXPECT_EQ(with(24, 9), "a BMP with an unknown compression");
    EXPECT_EQ(with(1, 3, 64), "a BMP with Huffman codes");
    EXPECT_EQ(with(24, 4, 64), "a BMP with RLE of 24 bits");
    EXPECT_EQ(with(3, 0), "a BMP with a depth that does not exist");
    EXPECT_EQ(with(24, 0, 41), "a BMP with a header of 41 bytes");
    EXPECT_EQ(with(4, 1), "damaged: RLE of another depth");
    BmpFile masks;
    masks.depth = 32;
    masks.compression = 3;
    masks.masks = {0xff, 0xff00, 0x50000};
    masks.texel = noise;
    EXPECT_EQ(refusal_of(masks.make()), "damaged: a mask that is no run of bits");
    BmpFile top = rle_of(8, 6, 4);
    top.from_top = true;
    EXPECT_EQ(refusal_of(top.make()), "damaged: RLE with rows from the top");
    BmpFile large = rle_of(8, 6, 4);
    FileBytes bytes = large.make();
    bytes[20] = bytes[24] = std::byte{1};  // 65542 x 65540 texels
    EXPECT_EQ(read_bmp(bytes).error().code, ErrorCode::unsupported);
    bytes[20] = bytes[24] = std::byte{0};
    bytes[19] = bytes[23] = std::byte{0x7f};
    EXPECT_EQ(read_bmp(bytes).error().code, ErrorCode::bad_data);
    bytes[10] = bytes[11] = std::byte{1};
    EXPECT_EQ(read_bmp(bytes).error().code, ErrorCode::bad_data);
}

TEST(Bmp, WritesWhatItReads) {
    for (const Format format : {Format::r8_unorm, Format::rgb8_unorm}) {
        Texture texture;
        texture.format = format;
        texture.levels.push_back({{13, 7}, std::vector<std::byte>(level_bytes(format, {13, 7}))});
        for (std::size_t k = 0; k < texture.levels[0].bytes.size(); ++k)
            texture.levels[0].bytes[k] = static_cast<std::byte>(k * 37);
        const auto bytes = encode_file(texture, Container::bmp);
        ASSERT_TRUE(bytes) << bytes.error().message();
        Result<InputFile> file = InputFile::from_memory("a.bmp", *bytes);
        const Result<Texture> again = read_texture(*file, {});
        ASSERT_TRUE(again) << again.error().message();
        EXPECT_EQ(again->format, format);
        EXPECT_EQ(again->levels[0].bytes, texture.levels[0].bytes);
    }
}

}  // namespace
}  // namespace tex
