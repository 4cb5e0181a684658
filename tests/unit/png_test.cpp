// SPDX-License-Identifier: Apache-2.0

#include "formats/png/png.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>
#include <tex/check.h>

#include <csetjmp>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string_view>

#include "formats/exif.h"
#include "formats/png/png_chunk.h"
#include "unit/exif_data.h"

namespace tex {
namespace {

using Bytes = std::vector<std::byte>;

Result<Image> read(Bytes bytes, const ReadOptions& options = {}) {
    Result<InputFile> file = InputFile::from_memory("test.png", std::move(bytes));
    if (!file) return file.error();
    return read_all(open_png(*file, options));
}

// One type of PNG, written by libpng.
struct Kind {
    int color_type;
    int bits;
    bool interlaced;
    bool transparent;  // has a tRNS chunk
};

constexpr int kWidth = 19;
constexpr int kHeight = 11;

// The code of channel c at (i, j): runs through all codes of n bits.
unsigned code(const Kind& kind, int i, int j, int c) {
    return static_cast<unsigned>((j * kWidth + i) * 37 + c * 101 + (j << 9)) & ((1u << kind.bits) - 1u);
}

int channels_of(int color_type) {
    switch (color_type) {
        case PNG_COLOR_TYPE_GRAY_ALPHA: return 2;
        case PNG_COLOR_TYPE_RGB: return 3;
        case PNG_COLOR_TYPE_RGBA: return 4;
        default: return 1;
    }
}

void append(png_structp png, png_bytep data, std::size_t count) {
    auto* bytes = static_cast<Bytes*>(png_get_io_ptr(png));
    const auto* from = reinterpret_cast<const std::byte*>(data);
    bytes->insert(bytes->end(), from, from + count);
}

// Palette entry v is (v, 255 - v, v / 2) with alpha 255 - 3 v.
Bytes make_png(const Kind& kind) {
    Bytes bytes;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(png, &bytes, append, nullptr);
    png_set_IHDR(png, info, kWidth, kHeight, kind.bits, kind.color_type,
                 kind.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, 0, 0);
    if (kind.color_type == PNG_COLOR_TYPE_PALETTE) {
        png_color palette[256];
        png_byte alpha[256];
        const int n = 1 << kind.bits;
        for (int v = 0; v < n; ++v) {
            palette[v] = {static_cast<png_byte>(v), static_cast<png_byte>(255 - v), static_cast<png_byte>(v / 2)};
            alpha[v] = static_cast<png_byte>(255 - 3 * v);
        }
        png_set_PLTE(png, info, palette, n);
        if (kind.transparent) png_set_tRNS(png, info, alpha, n, nullptr);
    } else if (kind.transparent) {
        png_color_16 key{};
        key.gray = key.red = static_cast<png_uint_16>(code(kind, 3, 2, 0));
        key.green = static_cast<png_uint_16>(code(kind, 3, 2, 1));
        key.blue = static_cast<png_uint_16>(code(kind, 3, 2, 2));
        png_set_tRNS(png, info, nullptr, 0, &key);
    }
    png_set_gAMA(png, info, 0.45455);  // must have no effect
    png_color_8 significant{};
    significant.red = significant.green = significant.blue = significant.gray = significant.alpha = 1;
    png_set_sBIT(png, info, &significant);
    png_write_info(png, info);
    png_set_packing(png);

    const int channels = channels_of(kind.color_type);
    const std::size_t row_bytes = static_cast<std::size_t>(kWidth * channels * (kind.bits == 16 ? 2 : 1));
    std::vector<std::vector<png_byte>> rows(kHeight, std::vector<png_byte>(row_bytes));
    std::vector<png_bytep> pointers;
    for (int j = 0; j < kHeight; ++j) {
        png_bytep p = rows[static_cast<std::size_t>(j)].data();
        pointers.push_back(p);
        for (int i = 0; i < kWidth; ++i) {
            for (int c = 0; c < channels; ++c) {
                const unsigned v = code(kind, i, j, c);
                if (kind.bits == 16) *p++ = static_cast<png_byte>(v >> 8);
                *p++ = static_cast<png_byte>(v & 255u);
            }
        }
    }
    png_write_image(png, pointers.data());
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return bytes;
}

float expected(const Kind& kind, int i, int j, std::size_t plane, std::size_t planes) {
    const int channels = channels_of(kind.color_type);
    const float top = static_cast<float>((1u << kind.bits) - 1u);
    if (kind.color_type == PNG_COLOR_TYPE_PALETTE) {
        const int v = static_cast<int>(code(kind, i, j, 0));
        const int entry[4] = {v, 255 - v, v / 2, (255 - 3 * v) & 255};
        return static_cast<float>(entry[plane]) / 255.0f;
    }
    if (kind.transparent && plane + 1 == planes) {
        bool same = true;
        for (int c = 0; c < channels; ++c) same = same && code(kind, i, j, c) == code(kind, 3, 2, c);
        return same ? 0.0f : 1.0f;
    }
    return static_cast<float>(code(kind, i, j, static_cast<int>(plane))) / top;
}

TEST(Png, ReadsEveryKindExactly) {
    std::vector<Kind> kinds;
    for (const bool interlaced : {false, true}) {
        for (const bool transparent : {false, true}) {
            for (const int bits : {1, 2, 4, 8, 16})
                kinds.push_back({PNG_COLOR_TYPE_GRAY, bits, interlaced, transparent});
            for (const int bits : {1, 2, 4, 8})
                kinds.push_back({PNG_COLOR_TYPE_PALETTE, bits, interlaced, transparent});
            for (const int bits : {8, 16}) kinds.push_back({PNG_COLOR_TYPE_RGB, bits, interlaced, transparent});
        }
        for (const int bits : {8, 16}) {
            kinds.push_back({PNG_COLOR_TYPE_GRAY_ALPHA, bits, interlaced, false});
            kinds.push_back({PNG_COLOR_TYPE_RGBA, bits, interlaced, false});
        }
    }
    for (const Kind& kind : kinds) {
        SCOPED_TRACE(testing::Message() << "color type " << kind.color_type << ", " << kind.bits << " bits, interlaced "
                                        << kind.interlaced << ", tRNS " << kind.transparent);
        const Result<Image> image = read(make_png(kind));
        ASSERT_TRUE(image) << image.error().message();
        ASSERT_EQ(image->extent(), (Extent{kWidth, kHeight}));
        const int base = kind.color_type == PNG_COLOR_TYPE_PALETTE ? 3 : channels_of(kind.color_type);
        ASSERT_EQ(image->planes.size(), static_cast<std::size_t>(base + (kind.transparent ? 1 : 0)));
        EXPECT_EQ(image->bits, kind.color_type == PNG_COLOR_TYPE_PALETTE ? 8 : kind.bits);
        EXPECT_EQ(image->sample, SampleKind::unorm);
        EXPECT_EQ(image->names.front(), base < 3 ? "Y" : "R");
        EXPECT_EQ(image->find("A") >= 0, base % 2 == 0 || kind.transparent);
        for (std::size_t plane = 0; plane < image->planes.size(); ++plane) {
            for (int j = 0; j < kHeight; ++j) {
                for (int i = 0; i < kWidth; ++i) {
                    ASSERT_EQ(image->planes[plane].at(i, j), expected(kind, i, j, plane, image->planes.size()))
                        << "plane " << plane << " at " << i << ", " << j;
                }
            }
        }
    }
}

// The file with a chunk of EXIF data after its header, or before its end.
Bytes with_exif(Bytes file, std::string_view exif, bool at_end = false) {
    constexpr std::ptrdiff_t kAfterHeader = 33, kEndChunk = 12;
    Bytes chunk;
    const std::size_t begun = begin_png_chunk(chunk, "eXIf");
    for (const char c : exif) chunk.push_back(static_cast<std::byte>(c));
    end_png_chunk(chunk, begun);
    file.insert(at_end ? file.end() - kEndChunk : file.begin() + kAfterHeader, chunk.begin(), chunk.end());
    return file;
}

TEST(Png, TellsItsOrientationAndIsNotTurned) {
    const std::string wanted =
        "the picture was not turned or mirrored as its orientation (6) says, because PNG is read as it is stored; "
        "turn it in an editor, or remove the orientation";
    for (const bool interlaced : {false, true}) {
        const Bytes plain = make_png({PNG_COLOR_TYPE_RGB, 8, interlaced, false});
        const Result<Image> stored = read(plain);
        ASSERT_TRUE(stored);
        for (const std::string& mark : {std::string(), std::string(kExifMark)}) {
            const Result<Image> image = read(with_exif(plain, mark + exif_data(6, mark.empty())));
            ASSERT_TRUE(image) << image.error().message();
            EXPECT_EQ(image->remark, wanted);
            EXPECT_EQ(read(with_exif(plain, mark + exif_data(6, false), true))->remark, wanted);
            ASSERT_EQ(image->extent(), stored->extent());
            for (int j = 0; j < kHeight; ++j) EXPECT_EQ(image->planes[0].at(3, j), stored->planes[0].at(3, j));
        }
        for (const std::string& silent :
             {exif_data(1, false), exif_data(9, true), exif_data(0, true), std::string("II")})
            EXPECT_EQ(read(with_exif(plain, silent))->remark, "");
    }
}

TEST(Png, OrientationsOfTexturesAreFindings) {
    const Bytes file = with_exif(make_png({PNG_COLOR_TYPE_RGB, 8, false, false}), exif_data(6, false));
    const Result<Texture> texture = read_texture(file, "turned.png");
    ASSERT_TRUE(texture);
    EXPECT_EQ(texture->orientation, 6);
    EXPECT_FALSE(texture->turned);
    const auto report = check("turned.png", *texture);
    ASSERT_TRUE(report);
    std::vector<std::string> found;
    for (const Finding& finding : report->findings) {
        if (finding.rule->family == RuleFamily::file) found.push_back(std::string(finding.rule->id) + finding.message);
    }
    EXPECT_THAT(found, testing::Contains(
                           testing::AllOf(testing::StartsWith("N116"), testing::HasSubstr("read as they are stored"))));
    EXPECT_THAT(found, testing::Not(testing::Contains(testing::StartsWith("N102"))));
}

TEST(Png, EveryTruncationIsDamage) {
    for (const bool interlaced : {false, true}) {
        const Bytes whole = make_png({PNG_COLOR_TYPE_RGB, 16, interlaced, false});
        for (std::size_t n = 1; n < whole.size(); ++n) {
            const Result<Image> image = read(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(n)));
            ASSERT_FALSE(image) << n;
            ASSERT_EQ(image.error().code, ErrorCode::bad_data) << n;
        }
    }
}

TEST(Png, EveryFlippedByteOfTheDataIsDamage) {
    const Bytes whole = make_png({PNG_COLOR_TYPE_GRAY, 8, false, false});
    for (std::size_t n = 0; n < whole.size(); ++n) {
        Bytes damaged = whole;
        damaged[n] ^= std::byte{0x10};
        const Result<Image> image = read(std::move(damaged));
        EXPECT_FALSE(image) << n;  // each byte belongs to a CRC or is covered by one
    }
}

void put32(Bytes& bytes, std::uint32_t v) {
    for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::byte>(v >> shift));
}

// A PNG with a sound header and a data chunk of `data` zero bytes.
Bytes claiming(std::uint32_t width, std::uint32_t height, std::size_t data) {
    Bytes bytes;
    const auto text = [&](const char* s, std::size_t n) {
        for (std::size_t k = 0; k < n; ++k) bytes.push_back(static_cast<std::byte>(s[k]));
    };
    const auto crc_from = [&](std::size_t at) {
        std::uint32_t crc = 0xffffffffu;
        for (std::size_t k = at; k < bytes.size(); ++k) {
            crc ^= static_cast<std::uint32_t>(bytes[k]);
            for (int b = 0; b < 8; ++b) crc = crc >> 1 ^ ((crc & 1u) != 0 ? 0xedb88320u : 0u);
        }
        put32(bytes, ~crc);
    };
    text("\x89PNG\r\n\x1a\n", 8);
    put32(bytes, 13);
    text("IHDR", 4);
    put32(bytes, width);
    put32(bytes, height);
    text("\x10\x02\0\0\0", 5);
    crc_from(12);
    put32(bytes, static_cast<std::uint32_t>(data));
    const std::size_t at = bytes.size();
    text("IDAT", 4);
    bytes.resize(bytes.size() + data);
    crc_from(at);
    put32(bytes, 0);
    text("IEND\xae\x42\x60\x82", 8);
    return bytes;
}

TEST(Png, RefusesClaimsBeforeTakingMemory) {
    const Result<Image> small = read(claiming(100'000, 100'000, 100));
    ASSERT_FALSE(small);
    EXPECT_EQ(small.error().code, ErrorCode::bad_data);
    EXPECT_NE(small.error().reason.find("claims 100000x100000 texels"), std::string::npos) << small.error().reason;

    EXPECT_FALSE(read(claiming(0x7fffffff, 0x7fffffff, 100)));
    EXPECT_FALSE(read(claiming(0, 5, 100)));
    EXPECT_FALSE(read(claiming(0xffffffff, 5, 100)));

    ReadOptions options;
    options.max_texels = 100;
    const Result<Image> large = read(claiming(101, 1, 1000), options);
    ASSERT_FALSE(large);
    EXPECT_EQ(large.error().code, ErrorCode::unsupported);
    const Result<Image> wide = read(claiming(kMaxExtent + 1, 1, 10'000));
    ASSERT_FALSE(wide);
    EXPECT_EQ(wide.error().code, ErrorCode::unsupported);
}

Texture texture_of(Format format, Extent extent) {
    Texture texture;
    texture.format = format;
    Level level{extent, Bytes(level_bytes(format, extent))};
    for (std::size_t k = 0; k < level.bytes.size(); ++k) level.bytes[k] = static_cast<std::byte>(k * k / 7 + k);
    texture.levels.push_back(std::move(level));
    return texture;
}

TEST(Png, WritesWhatItReads) {
    for (const Format format : {Format::r8_unorm, Format::rgb8_unorm, Format::rgba8_unorm, Format::r16_unorm,
                                Format::rgb16_unorm, Format::rgba16_unorm}) {
        SCOPED_TRACE(name_of(kFormatNames, format));
        const Texture texture = texture_of(format, {33, 7});
        const Result<Bytes> bytes = encode_png(texture);
        ASSERT_TRUE(bytes) << bytes.error().message();
        const Result<Image> image = read(*bytes);
        ASSERT_TRUE(image) << image.error().message();
        const FormatInfo info = format_info(format);
        ASSERT_EQ(image->planes.size(), static_cast<std::size_t>(info.channels));
        ASSERT_EQ(image->bits, info.bits);
        const Bytes& stored = texture.levels.front().bytes;
        std::size_t at = 0;
        for (int j = 0; j < 7; ++j) {
            for (int i = 0; i < 33; ++i) {
                for (const Plane<float>& plane : image->planes) {
                    unsigned v = static_cast<unsigned>(stored[at++]);
                    if (info.bits == 16) v |= static_cast<unsigned>(stored[at++]) << 8;
                    ASSERT_EQ(plane.at(i, j), static_cast<float>(v) / (info.bits == 16 ? 65535.0f : 255.0f));
                }
            }
        }
    }
}

TEST(Png, HoldsNothingButThePicture) {
    const Result<Bytes> bytes = encode_png(texture_of(Format::rgb8_unorm, {64, 64}));
    ASSERT_TRUE(bytes);
    const auto length = [&](std::size_t at) {
        std::uint32_t v = 0;
        for (std::size_t k = 0; k < 4; ++k) v = v << 8 | static_cast<std::uint32_t>((*bytes)[at + k]);
        return v;
    };
    for (std::size_t at = 8; at < bytes->size(); at += 12 + length(at)) {
        const std::string chunk(reinterpret_cast<const char*>(bytes->data()) + at + 4, 4);
        EXPECT_TRUE(chunk == "IHDR" || chunk == "IDAT" || chunk == "IEND") << chunk;
    }
}

TEST(Png, RefusesFormatsThatItCannotHold) {
    for (const Format format : {Format::bc3_unorm, Format::rg8_unorm, Format::rgb16_float, Format::rgba8_snorm}) {
        const Result<Bytes> bytes = encode_png(texture_of(format, {4, 4}));
        ASSERT_FALSE(bytes);
        EXPECT_EQ(bytes.error().code, ErrorCode::unsupported);
    }
}

}  // namespace
}  // namespace tex
