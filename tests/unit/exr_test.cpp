// SPDX-License-Identifier: Apache-2.0

#include "formats/exr/exr.h"
#include "formats/exr/exr_part.h"
#include "formats/exr/exr_rows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <ImfTiledOutputFile.h>

#include <tex/types.h>

#include "reference/exr_file.h"
#include "unit/exr_files.h"

namespace tex {
namespace {

using Bytes = std::vector<std::byte>;

Result<InputFile> open(const Bytes& bytes) { return InputFile::from_memory("test.exr", bytes); }

Result<Image> read(const Bytes& bytes, const ReadOptions& options = {}) {
    Result<InputFile> file = open(bytes);
    if (!file) return file.error();
    return read_all(open_exr_rows(*file, options));
}

TEST(Exr, ReadsEveryTypeCompressionAndLayoutExactly) {
    const Extent extent{37, 21};
    for (const Imf::PixelType type : {Imf::HALF, Imf::FLOAT, Imf::UINT}) {
        for (const Imf::Compression compression : {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION,
                                                   Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION}) {
            for (const bool tiled : {false, true}) {
                SCOPED_TRACE(testing::Message() << type << ", " << compression << ", " << tiled);
                const Result<Image> image = read(exr_file(extent, {"G", "R", "B"}, type, compression, tiled));
                ASSERT_TRUE(image) << image.error().message();
                ASSERT_EQ(image->extent(), extent);
                ASSERT_EQ(image->names, (std::vector<std::string>{"R", "G", "B"}));
                EXPECT_EQ(image->bits, type == Imf::HALF ? 16 : 32);
                EXPECT_EQ(image->sample, type == Imf::UINT ? SampleKind::unorm : SampleKind::floating);
                for (int j = 0; j < extent.height; ++j) {
                    for (int i = 0; i < extent.width; ++i) {
                        if (type == Imf::UINT) {
                            const std::uint32_t code =
                                static_cast<std::uint32_t>(i) * 123456789u + static_cast<std::uint32_t>(j);
                            ASSERT_EQ(image->planes[0].at(i, j), static_cast<float>(code / 4294967295.0));
                        } else {
                            ASSERT_EQ(image->planes[0].at(i, j), exr_value(i, j, 1));
                            ASSERT_EQ(image->planes[1].at(i, j), exr_value(i, j, 0));
                            ASSERT_EQ(image->planes[2].at(i, j), exr_value(i, j, 2));
                        }
                    }
                }
            }
        }
    }
}

TEST(Exr, KeepsOtherChannelNames) {
    const Result<Image> image =
        read(exr_file({5, 4}, {"height", "A", "diffuse.R", "Z"}, Imf::FLOAT, Imf::ZIP_COMPRESSION));
    ASSERT_TRUE(image);
    EXPECT_EQ(image->names, (std::vector<std::string>{"A", "Z", "diffuse.R", "height"}));
    EXPECT_EQ(image->planes[3].at(2, 1), exr_value(2, 1, 0));
}

TEST(Exr, RefusesDeepData) {
    Imf::Header header(4, 4);
    header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
    header.setType(Imf::DEEPSCANLINE);
    header.compression() = Imf::ZIPS_COMPRESSION;
    Bytes bytes;
    ExrSink sink(bytes);
    {
        Imf::DeepScanLineOutputFile file(sink, header);
        unsigned counts[16] = {};
        const float* pointers[16] = {};
        Imf::DeepFrameBuffer buffer;
        buffer.insertSampleCountSlice(Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts), 4, 16));
        buffer.insert("Z", Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(pointers), 8, 32, 4));
        file.setFrameBuffer(buffer);
        file.writePixels(4);
    }
    const Result<Image> image = read(bytes);
    ASSERT_FALSE(image);
    EXPECT_EQ(image.error().code, ErrorCode::unsupported) << image.error().reason;
}

TEST(Exr, RefusesSubsampledChannels) {
    Imf::Header header(4, 4);
    header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
    header.channels().insert("RY", Imf::Channel(Imf::FLOAT, 2, 2));
    Bytes bytes;
    ExrSink sink(bytes);
    std::vector<float> values(16);
    {
        Imf::OutputFile file(sink, header);
        Imf::FrameBuffer buffer;
        buffer.insert("Y", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), 4, 16));
        buffer.insert("RY", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), 4, 8, 2, 2));
        file.setFrameBuffer(buffer);
        file.writePixels(4);
    }
    const Result<Image> image = read(bytes);
    ASSERT_FALSE(image);
    EXPECT_EQ(image.error().code, ErrorCode::unsupported);
    EXPECT_EQ(image.error().reason, "the channel RY is subsampled");
}

// OpenImageIO gives the same texels, and the place among its other values.
TEST(Exr, ACropIsReadAloneAndSaysSo) {
    const auto remark_of = [](const Imath::Box2i& data) {
        Imf::Header header(16, 16);
        header.dataWindow() = data;
        header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
        Bytes bytes;
        ExrSink sink(bytes);
        std::vector<float> values(1024);
        {
            Imf::OutputFile file(sink, header);
            Imf::FrameBuffer buffer;
            buffer.insert("Y", Imf::Slice::Make(Imf::FLOAT, values.data(), data));
            file.setFrameBuffer(buffer);
            file.writePixels(data.max.y - data.min.y + 1);
        }
        const Result<Image> image = read(bytes);
        return image ? std::to_string(image->extent().width) + ": " + image->remark : image.error().reason;
    };
    EXPECT_EQ(remark_of({{0, 0}, {15, 15}}), "16: ");
    EXPECT_EQ(remark_of({{4, 2}, {11, 9}}),
              "8: holds 8x8 texels from column 4, row 2 of a picture of 16x16 (data window and display window), which "
              "are read alone");
    EXPECT_EQ(remark_of({{-2, -2}, {17, 17}}).substr(0, 46), "20: holds 20x20 texels from column -2, row -2 ");
}

TEST(Exr, OfSeveralPartsReadsTheFirst) {
    std::vector<Imf::Header> headers(2, Imf::Header(4, 3));
    headers[1].dataWindow() = Imath::Box2i({0, 0}, {7, 7});
    for (std::size_t k = 0; k < 2; ++k) {
        headers[k].setName(k == 0 ? "first" : "second");
        headers[k].setType(Imf::SCANLINEIMAGE);
        headers[k].channels().insert("Y", Imf::Channel(Imf::FLOAT));
    }
    Bytes bytes;
    ExrSink sink(bytes);
    std::vector<float> values(64, 0.75f);
    {
        Imf::MultiPartOutputFile file(sink, headers.data(), 2);
        for (int k = 0; k < 2; ++k) {
            Imf::OutputPart part(file, k);
            Imf::FrameBuffer buffer;
            buffer.insert("Y", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), 4, 32));
            part.setFrameBuffer(buffer);
            part.writePixels(k == 0 ? 3 : 8);
        }
    }
    const Result<Image> image = read(bytes);
    ASSERT_TRUE(image) << image.error().message();
    EXPECT_EQ(image->extent(), (Extent{4, 3}));
    EXPECT_EQ(image->planes[0].at(3, 2), 0.75f);
}

// Parts of 40 x 37 texels, whose chunks are mixed. Channel c of part k holds 100 k + 10 c + line / 8.
Bytes parts_file(const std::vector<std::string>& names, const std::vector<std::vector<std::string>>& channels,
                 Imf::Compression compression) {
    constexpr int kWidth = 40, kHeight = 37;
    std::vector<Imf::Header> headers(names.size(), Imf::Header(kWidth, kHeight));
    for (std::size_t k = 0; k < names.size(); ++k) {
        headers[k].setName(names[k]);
        headers[k].setType(Imf::SCANLINEIMAGE);
        headers[k].compression() = compression;
        for (const std::string& name : channels[k]) headers[k].channels().insert(name, Imf::Channel(Imf::FLOAT));
    }
    Bytes bytes;
    ExrSink sink(bytes);
    Imf::MultiPartOutputFile file(sink, headers.data(), static_cast<int>(headers.size()));
    for (int line = 0; line < kHeight; ++line) {
        for (std::size_t k = 0; k < names.size(); ++k) {
            Imf::FrameBuffer buffer;
            std::vector<std::vector<float>> values;
            for (std::size_t c = 0; c < channels[k].size(); ++c) {
                const auto base = static_cast<float>(100 * k + 10 * c);
                values.emplace_back(kWidth, base + 0.125f * static_cast<float>(line));
                buffer.insert(channels[k][c],
                              Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.back().data()), 4, 0));
            }
            Imf::OutputPart part(file, static_cast<int>(k));
            part.setFrameBuffer(buffer);
            part.writePixels(1);
        }
    }
    return bytes;
}

// Nuke and Blender write them so: the name of the part is that of the layer, or the channels have it too.
TEST(Exr, LayersMayBeParts) {
    for (const Imf::Compression compression : {Imf::ZIP_COMPRESSION, Imf::NO_COMPRESSION, Imf::PIZ_COMPRESSION}) {
        for (const std::string prefix : {"", "normal."}) {
            SCOPED_TRACE(testing::Message() << compression << " " << prefix);
            const std::vector<std::string> normal = {prefix + "X", prefix + "Y", prefix + "Z"};
            const Bytes bytes =
                parts_file({"beauty", "normal", "depth"}, {{"B", "G", "R"}, normal, {"depth.Z"}}, compression);
            ReadOptions options;
            options.layer = "normal";
            const Result<Image> image = read(bytes, options);
            ASSERT_TRUE(image) << image.error().message();
            ASSERT_EQ(image->names, normal);
            EXPECT_EQ(image->planes[1].at(39, 36), 110.0f + 36 * 0.125f);
            Result<InputFile> file = InputFile::from_memory("test.exr", bytes);
            const Result<TextureRows> rows = open_exr_texture_rows(*file, {});
            ASSERT_TRUE(rows) << rows.error().message();
            EXPECT_EQ(rows->head.remarks,
                      (std::vector<std::string>{"the first part beauty is read, of several that could hold normals"}));
            options.layer = "depth";
            const Result<Image> depth = read(bytes, options);
            ASSERT_TRUE(depth) << depth.error().message();
            EXPECT_EQ(depth->planes[0].at(0, 8), 201.0f);
            options.layer = "specular";
            const Result<Image> none = read(bytes, options);
            ASSERT_FALSE(none);
            EXPECT_EQ(none.error().reason,
                      "the picture has no layer \"specular\"; its layers are beauty, normal, depth");
        }
    }
}

TEST(Exr, EveryTruncationIsDamage) {
    for (const bool tiled : {false, true}) {
        const Bytes whole = exr_file({37, 21}, {"R", "G", "B"}, Imf::HALF, Imf::ZIP_COMPRESSION, tiled);
        for (std::size_t n = 1; n < whole.size(); ++n) {
            const Result<Image> image = read(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(n)));
            ASSERT_FALSE(image) << n << " of " << whole.size();
            ASSERT_EQ(image.error().code, ErrorCode::bad_data) << n << ": " << image.error().reason;
        }
    }
}

TEST(Exr, RefusesClaimsBeforeTakingMemory) {
    for (const Imf::Compression compression : {Imf::NO_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION}) {
        Bytes bytes = exr_file({4, 4}, {"Y"}, Imf::HALF, compression);
        const std::string name = "dataWindow";
        auto at = std::search(bytes.begin(), bytes.end(), name.begin(), name.end(),
                              [](std::byte a, char b) { return static_cast<char>(a) == b; });
        ASSERT_NE(at, bytes.end());
        at += 11 + 6 + 4;                                   // the name, the type "box2i", the size
        const std::int32_t window[4] = {0, 0, 999'999, 3};  // the same number of chunks, but wider
        std::memcpy(&*at, window, sizeof window);
        const Result<Image> image = read(bytes);
        ASSERT_FALSE(image);
        EXPECT_EQ(image.error().code, ErrorCode::bad_data) << image.error().reason;
    }
}

TEST(Exr, RefusesAttributesThatClaimMoreThanTheFileHolds) {
    Bytes bytes = exr_file({4, 4}, {"Y"}, Imf::HALF, Imf::ZIP_COMPRESSION);
    const std::string name = "screenWindowWidth";
    auto at = std::search(bytes.begin(), bytes.end(), name.begin(), name.end(),
                          [](std::byte a, char b) { return static_cast<char>(a) == b; });
    ASSERT_NE(at, bytes.end());
    at += 18 + 6;  // the name, the type "float"
    for (const std::int32_t claim : {0x7fffffff, 0x40000000, -1}) {
        std::memcpy(&*at, &claim, sizeof claim);
        const Result<Image> image = read(bytes);
        ASSERT_FALSE(image);
        EXPECT_EQ(image.error().code, ErrorCode::bad_data);
        EXPECT_NE(image.error().reason.find("an attribute claims"), std::string::npos) << image.error().reason;
    }
}

// The bytes after `name` and its type (both with their final 0) in a header: an attribute's size, then its value.
std::byte* attribute(Bytes& bytes, const std::string& name, const std::string& type) {
    const std::string start = name + '\0' + type + '\0';
    const auto at = std::search(bytes.begin(), bytes.end(), start.begin(), start.end(),
                                [](std::byte a, char b) { return static_cast<char>(a) == b; });
    return at == bytes.end() ? nullptr : &*at + start.size();
}

TEST(Exr, RefusesTilesWhoseAreaOverflows) {
    Bytes bytes = exr_file({37, 21}, {"Y"}, Imf::HALF, Imf::ZIP_COMPRESSION, true);
    std::byte* tiles = attribute(bytes, "tiles", "tiledesc");
    ASSERT_NE(tiles, nullptr);
    // The first pair overflows 64 signed bits, the others 32 bits.
    for (const auto& [x, y] : {std::pair{0xffffffffu, 0xffffffffu}, {0x80000000u, 2u}, {0x10000u, 0x10000u}}) {
        std::memcpy(tiles + 4, &x, 4);
        std::memcpy(tiles + 8, &y, 4);
        const Result<Image> image = read(bytes);
        ASSERT_FALSE(image) << x << " x " << y;
        EXPECT_EQ(image.error().code, ErrorCode::bad_data) << image.error().reason;
    }
}

TEST(Exr, RefusesAttributesWhoseSizeIsNotTheirValuesOwn) {
    for (const std::int32_t size : {0, 3, 5, 8}) {
        Bytes bytes = exr_file({4, 4}, {"Y"}, Imf::HALF, Imf::ZIP_COMPRESSION);
        std::byte* width = attribute(bytes, "screenWindowWidth", "float");
        ASSERT_NE(width, nullptr);
        std::memcpy(width, &size, sizeof size);
        const Result<Image> image = read(bytes);
        ASSERT_FALSE(image) << size;
        EXPECT_NE(image.error().reason.find("has a wrong size"), std::string::npos) << image.error().reason;
    }
}

// Crashes programs that ask OpenEXR for the views of a file (CVE-2026-61555).
TEST(Exr, AnEmptyListOfViewsDoesNoHarm) {
    const Bytes sound = exr_file({5, 4}, {"B", "G", "R"}, Imf::HALF, Imf::ZIP_COMPRESSION);
    auto parsed = reference::parse_exr({reinterpret_cast<const char*>(sound.data()), sound.size()});
    ASSERT_TRUE(parsed);
    parsed->parts[0].push_back({"multiView", "stringvector", ""});
    const std::string text = reference::write_exr(*parsed);
    const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
    const Result<Image> image = read({bytes, bytes + text.size()});
    ASSERT_TRUE(image) << image.error().message();
    EXPECT_EQ(image->planes[0].at(4, 3), exr_value(4, 3, 2));
}

TEST(Exr, RefusesMoreTexelsThanTheLimit) {
    ReadOptions options;
    options.max_texels = 15;
    EXPECT_EQ(read(exr_file({4, 4}, {"Y"}, Imf::HALF, Imf::ZIP_COMPRESSION), options).error().code,
              ErrorCode::unsupported);
}

Texture texture_of(Format format, Extent extent, int levels) {
    const FormatInfo info = format_info(format);
    Texture texture;
    texture.format = format;
    texture.y_axis = YAxis::down;
    texture.y_known = true;
    for (int k = 0; k < levels; ++k) {
        Image image;
        Level level{level_extent(extent, k), {}};
        for (int j = 0; j < level.extent.height; ++j) {
            for (int i = 0; i < level.extent.width; ++i) {
                for (int c = 0; c < info.channels; ++c) {
                    const float v = exr_value(i, j, c + 5 * k);
                    const std::uint16_t h = Imath::half(v).bits();
                    const auto* from = info.bits == 16 ? reinterpret_cast<const std::byte*>(&h)
                                                       : reinterpret_cast<const std::byte*>(&v);
                    level.bytes.insert(level.bytes.end(), from, from + info.bits / 8);
                }
            }
        }
        texture.levels.push_back(std::move(level));
    }
    return texture;
}

TEST(Exr, TexturesComeBackWithTheirLevels) {
    for (const Format format :
         {Format::r16_float, Format::rg32_float, Format::rgb16_float, Format::rgb32_float, Format::rgba16_float}) {
        for (const int levels : {1, level_count({131, 70})}) {
            SCOPED_TRACE(name_of(kFormatNames, format));
            const Texture texture = texture_of(format, {131, 70}, levels);
            const Result<Bytes> bytes = encode_exr(texture);
            ASSERT_TRUE(bytes) << bytes.error().message();
            Result<InputFile> file = open(*bytes);
            const Result<Texture> back = read_all(open_exr_texture_rows(*file, {}));
            ASSERT_TRUE(back) << back.error().message();
            EXPECT_EQ(back->format, format);
            EXPECT_EQ(back->y_axis, YAxis::down);
            EXPECT_TRUE(back->y_known);
            EXPECT_EQ(back->normal_encoding, "signed");
            ASSERT_EQ(back->levels.size(), static_cast<std::size_t>(levels));
            for (std::size_t k = 0; k < texture.levels.size(); ++k) {
                EXPECT_EQ(back->levels[k].extent, texture.levels[k].extent);
                EXPECT_EQ(back->levels[k].bytes, texture.levels[k].bytes) << k;
            }
            EXPECT_EQ(*encode_exr(texture), *bytes);
        }
    }
}

TEST(Exr, RefusesWhatItCannotHold) {
    EXPECT_EQ(encode_exr(texture_of(Format::rgb8_unorm, {4, 4}, 1)).error().code, ErrorCode::unsupported);
    EXPECT_EQ(encode_exr(texture_of(Format::rgb16_float, {16, 16}, 2)).error().code, ErrorCode::unsupported);
}

TEST(Exr, NanAndInfiniteValuesAreAsStored) {
    Result<InputFile> file = InputFile::open(TEX_SOURCE_DIR "/../shared/data/height/reader_nan_inf_800x800.exr");
    if (!file) GTEST_SKIP() << "no shared data";
    const Result<Image> image = read_all(open_exr_rows(*file, {}));
    ASSERT_TRUE(image) << image.error().message();
    int nan = 0, infinite = 0;
    for (const Plane<float>& plane : image->planes) {
        for (int j = 0; j < 800; ++j) {
            for (int i = 0; i < 800; ++i) {
                nan += std::isnan(plane.at(i, j));
                infinite += std::isinf(plane.at(i, j));
            }
        }
    }
    EXPECT_GT(nan + infinite, 0);
}

}  // namespace
}  // namespace tex
