// SPDX-License-Identifier: Apache-2.0

#include "formats/tga/tga.h"
#include "formats/bottom_up.h"
#include "formats/byte_range.h"
#include "formats/code_rows.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>

#include <tex/file.h>

#include "formats/file_types.h"
#include "formats/size_limits.h"
#include "reference/tga_file.h"

namespace tex {
namespace {

using reference::FileBytes;
using reference::TgaFile;

// Runs and lone texels; in rows of 5 some runs cross their ends.
std::uint32_t seed(int i, int j) { return (static_cast<std::uint32_t>(i / 2 + j * 3) * 2654435761u) >> 4; }

Result<Image> read_tga(const FileBytes& bytes) {
    Result<InputFile> file = InputFile::from_memory("a.tga", bytes);
    return file ? read_image(*file, {}) : Result<Image>(file.error());
}

std::string reason_of(const FileBytes& bytes) {
    const Result<Image> image = read_tga(bytes);
    return image ? "none" : image.error().reason;
}

using Codes = std::array<std::uint32_t, 4>;  // R, G, B, A

Codes codes_of(std::uint32_t stored, int depth) {
    if (depth == 15 || depth == 16) return {stored >> 10 & 31, stored >> 5 & 31, stored & 31, 31};
    return {stored >> 16 & 255, stored >> 8 & 255, stored & 255, depth == 32 ? stored >> 24 & 255 : 255};
}

using Expected = std::function<Codes(int i, int j)>;

void expect_texels(const FileBytes& bytes, const std::vector<std::string>& names, int bits, const Expected& expected) {
    const Result<Image> image = read_tga(bytes);
    ASSERT_TRUE(image) << image.error().message();
    EXPECT_EQ(image->names, names);
    EXPECT_EQ(image->bits, bits);
    const auto greatest = static_cast<float>((1 << bits) - 1);
    for (int j = 0; j < image->extent().height; ++j) {
        for (int i = 0; i < image->extent().width; ++i) {
            const Codes codes = expected(i, j);
            for (std::size_t c = 0; c < names.size(); ++c)
                ASSERT_EQ(image->planes[c].at(i, j), static_cast<float>(codes[c]) / greatest) << i << "," << j;
        }
    }
}

const std::vector<std::string> kGrey{"Y"}, kGreyAlpha{"Y", "A"}, kColor{"R", "G", "B"}, kColorAlpha{"R", "G", "B", "A"};

// Calls check(file) with all origins, with RLE and without, with packets that cross rows and with a footer.
void of_every_form(TgaFile file, const std::function<void(const TgaFile&)>& check) {
    const int type = file.type, attribute = file.attribute_type;
    for (int form = 0; form < 32; ++form) {
        file.from_top = (form & 1) != 0;
        file.from_right = (form & 2) != 0;
        file.type = type + ((form & 4) != 0 ? 8 : 0);
        file.packets_cross_rows = (form & 8) != 0;
        file.attribute_type = (form & 16) != 0 ? attribute : -1;
        file.id = (form & 16) != 0 ? "an id" : "";
        SCOPED_TRACE(testing::Message() << "form " << form << " depth " << file.depth);
        check(file);
    }
}

TEST(Tga, ReadsColoursOfEveryDepthOriginAndPacking) {
    for (const int depth : {15, 16, 24, 32}) {
        TgaFile file;
        file.depth = depth;
        file.alpha_bits = depth == 32 ? 8 : 0;
        file.attribute_type = depth == 32 ? 3 : 0;
        file.texel = [depth](int i, int j) { return seed(i, j) & (depth < 24 ? 0xffffu : 0xffffffffu); };
        of_every_form(file, [&](const TgaFile& one) {
            expect_texels(one.make(), depth == 32 ? kColorAlpha : kColor, depth < 24 ? 5 : 8,
                          [&](int i, int j) { return codes_of(one.texel(i, j), depth); });
        });
    }
}

TEST(Tga, ReadsGreyWithAndWithoutAlpha) {
    for (const int depth : {8, 16}) {
        for (const int alpha : {0, 8}) {
            if (depth != alpha + 8) continue;
            TgaFile file;
            file.type = 3;
            file.depth = depth;
            file.alpha_bits = alpha;
            file.attribute_type = alpha == 8 ? 3 : 0;
            file.texel = [](int i, int j) { return seed(i, j) & 0xffff; };
            of_every_form(file, [&](const TgaFile& one) {
                expect_texels(one.make(), alpha == 8 ? kGreyAlpha : kGrey, 8, [&](int i, int j) {
                    return Codes{one.texel(i, j) & 255, one.texel(i, j) >> 8, 0, 0};
                });
            });
        }
    }
}

TEST(Tga, ReadsPalettesOfEveryDepth) {
    for (const int depth : {8, 16}) {
        for (const int palette_depth : {15, 16, 24, 32}) {
            for (const int first : {0, 3}) {
                TgaFile file;
                file.type = 1;
                file.depth = depth;
                file.palette_depth = palette_depth;
                file.palette_first = first;
                file.alpha_bits = palette_depth == 32 ? 8 : 0;
                file.attribute_type = 3;
                for (int k = 0; k < 7; ++k)
                    file.palette.push_back(seed(k, 1) & (palette_depth < 24 ? 0xffffu : 0xffffffffu));
                file.texel = [first](int i, int j) { return seed(i, j) % 7 + static_cast<std::uint32_t>(first); };
                of_every_form(file, [&](const TgaFile& one) {
                    expect_texels(one.make(), palette_depth == 32 ? kColorAlpha : kColor, palette_depth < 24 ? 5 : 8,
                                  [&](int i, int j) {
                                      const auto index = one.texel(i, j) - static_cast<std::uint32_t>(first);
                                      return codes_of(one.palette[index], palette_depth);
                                  });
                });
            }
        }
    }
}

TEST(Tga, RunsOf128TexelsAndMoreCrossManyRows) {
    TgaFile file;
    file.width = 7;
    file.height = 300;
    file.type = 10;
    file.packets_cross_rows = true;
    file.texel = [](int, int j) { return j < 250 ? 0x123456u : static_cast<std::uint32_t>(j * 7919); };
    expect_texels(file.make(), kColor, 8, [&](int i, int j) { return codes_of(file.texel(i, j), 24); });
}

TEST(Tga, TheFooterDecidesWhatAlphaIs) {
    const auto names = [](int depth, int alpha_bits, int attribute) {
        TgaFile file;
        file.depth = depth;
        file.alpha_bits = alpha_bits;
        file.attribute_type = attribute;
        file.texel = [](int, int) { return 0x40808080u; };
        const Result<Image> image = read_tga(file.make());
        return image ? image->names : std::vector<std::string>{image.error().reason};
    };
    EXPECT_EQ(names(32, 8, -1), kColorAlpha);
    EXPECT_EQ(names(32, 0, -1), kColorAlpha);  // as many programs write it
    EXPECT_EQ(names(32, 8, -2), kColorAlpha);
    EXPECT_EQ(names(32, 0, 0), kColor);
    EXPECT_EQ(names(32, 8, 0), kColorAlpha);  // zeros that somebody did not mean
    EXPECT_EQ(names(32, 8, 1), kColor);
    EXPECT_EQ(names(32, 8, 2), kColorAlpha);
    EXPECT_EQ(names(32, 8, 3), kColorAlpha);
    EXPECT_EQ(names(32, 8, 4), kColorAlpha);
    TgaFile file;  // premultiplied: the colours stay
    file.depth = 32;
    file.alpha_bits = 8;
    file.attribute_type = 4;
    file.texel = [](int, int) { return 0x40302010u; };
    expect_texels(file.make(), kColorAlpha, 8, [](int, int) { return Codes{0x30, 0x20, 0x10, 0x40}; });
}

TEST(Tga, RowsCanBeReadInAnyOrder) {
    TgaFile file;
    file.width = 33;
    file.height = 50;
    file.texel = [](int i, int j) { return seed(i / 3, j); };
    for (const int type : {2, 10}) {
        file.type = type;
        file.packets_cross_rows = true;
        Result<InputFile> input = InputFile::from_memory("a.tga", file.make());
        const auto rows = open_tga(*input, {});
        ASSERT_TRUE(rows) << rows.error().message();
        const Image whole = *read_all(open_tga(*input, {}));
        Image image = make_image(whole.extent(), whole.names);
        std::vector<std::byte> bytes((*rows)->row_bytes() * 7);
        EXPECT_TRUE((*rows)->is_random());
        for (int j = 43; j >= 0; j -= 7) {
            ASSERT_TRUE((*rows)->decode(j + (j == 43 ? 0 : 1), 7, bytes.data()));
            (*rows)->store(bytes.data(), 0, 7, image);
            const int first = j + (j == 43 ? 0 : 1);
            for (int k = 0; k < 7; ++k)
                ASSERT_EQ(std::memcmp(image.planes[1].row(k), whole.planes[1].row(first + k), 33 * sizeof(float)), 0);
        }
    }
}

TEST(Tga, SaysWhatIsWrong) {
    TgaFile file;
    file.texel = seed;
    const FileBytes whole = file.make();
    constexpr const char* kShort = "damaged: the file ends before its last row";
    for (std::size_t size = 18; size < whole.size(); ++size)
        EXPECT_EQ(reason_of({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}), kShort);
    file.type = 10;
    const FileBytes packed = file.make();
    for (std::size_t size = 18; size < packed.size(); ++size)
        EXPECT_EQ(reason_of({packed.begin(), packed.begin() + static_cast<std::ptrdiff_t>(size)}), kShort);
    EXPECT_EQ(reason_of({whole.begin(), whole.begin() + 17}), "not a picture, or of a type that is not supported");
    file.type = 1;
    file.depth = 8;
    EXPECT_EQ(reason_of(file.make()), "damaged: a picture of indices without a palette");
    file.palette = {1, 2};
    file.palette_depth = 24;
    file.texel = [](int i, int) { return static_cast<std::uint32_t>(i); };
    EXPECT_EQ(reason_of(file.make()), "damaged: a texel has a colour that the palette lacks");
    file.palette_first = 1;  // index 0 comes before the palette
    file.texel = [](int, int) { return 0u; };
    EXPECT_EQ(reason_of(file.make()), "damaged: a texel has a colour that the palette lacks");
    file = {};
    file.texel = seed;
    file.depth = 8;
    EXPECT_EQ(reason_of(file.make()), "a TGA with colours of 8 bits");
    file.type = 3;
    file.depth = 24;
    EXPECT_EQ(reason_of(file.make()), "a grey TGA of more than 16 bits");
    file.depth = 16;
    for (const int attribute : {-2, -1, 0}) {
        file.attribute_type = attribute;
        EXPECT_EQ(reason_of(file.make()),
                  "a grey TGA of 16 bits that counts no bits of alpha: its texels are grey and alpha, or one number");
    }
    file.attribute_type = 1;  // the second byte means nothing
    EXPECT_EQ(reason_of(file.make()), "none");
    file.type = 2;
    file.alpha_bits = 0x40;
    EXPECT_EQ(reason_of(file.make()), "a TGA with interleaved rows");
}

TEST(Tga, WritesWhatItReads) {
    for (const Format format : {Format::r8_unorm, Format::rgb8_unorm, Format::rgba8_unorm}) {
        Texture texture;
        texture.format = format;
        texture.levels.push_back({{13, 7}, std::vector<std::byte>(level_bytes(format, {13, 7}))});
        for (std::size_t k = 0; k < texture.levels[0].bytes.size(); ++k)
            texture.levels[0].bytes[k] = static_cast<std::byte>(k * 37);
        texture.swizzle_known = format != Format::r8_unorm;
        const auto bytes = encode_file(texture, Container::tga);
        ASSERT_TRUE(bytes) << bytes.error().message();
        Result<InputFile> file = InputFile::from_memory("a.tga", *bytes);
        const Result<Texture> again = read_texture(*file, {});
        ASSERT_TRUE(again) << again.error().message();
        EXPECT_EQ(again->format, format);
        EXPECT_EQ(again->levels[0].bytes, texture.levels[0].bytes);
        EXPECT_EQ(again->swizzle_known, texture.swizzle_known);
    }
    Texture wide;
    wide.format = Format::r8_unorm;
    wide.levels.push_back({{65536, 1}, std::vector<std::byte>(65536)});
    EXPECT_EQ(encode_file(wide, Container::tga).error().reason, "a side of a TGA has at most 65535 texels");
    EXPECT_EQ(encode_file(wide, Container::bmp).value().size(), 65536u + 1078u);
}

}  // namespace
}  // namespace tex
