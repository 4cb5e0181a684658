// SPDX-License-Identifier: Apache-2.0
// The encoding direction of containers/reader.h: pictures that only OpenImageIO writes.

#include "formats/reader/reader.h"
#include "formats/reader/reader_rows.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <cstring>
#include <string>

#include "unit/exif_data.h"

namespace tex {
namespace {

using Bytes = std::vector<std::byte>;

WriteOptions quick_write() {
    WriteOptions options;
    options.reader.reader_timeout = 20;
    return options;
}

void put_value(Bytes& bytes, std::uint32_t value, int count) {
    for (int k = 0; k < count; ++k) bytes.push_back(static_cast<std::byte>(value >> (8 * k)));
}

Result<Image> read_encoded(const Bytes& bytes) {
    Result<InputFile> file = InputFile::from_memory("test", bytes);
    if (!file) return file.error();
    return read_all(open_reader_rows(*file, quick_write().reader));
}

Texture texture_of(Format format, Extent extent) {
    const FormatInfo info = format_info(format);
    Texture texture;
    texture.format = format;
    Level level{extent, {}};
    for (std::int64_t k = 0; k < extent.texels() * info.channels; ++k) {
        const float v = static_cast<float>(k % 97) / 96.0f;
        if (info.sample == SampleKind::unorm) {
            put_value(level.bytes, static_cast<std::uint32_t>(v * (info.bits == 8 ? 255.0f : 65535.0f)), info.bits / 8);
        } else if (info.bits == 16) {
            put_value(level.bytes, static_cast<std::uint32_t>(k % 97) + 0x3800, 2);  // halves from 0.5 on
        } else {
            std::uint32_t bits = 0;
            std::memcpy(&bits, &v, 4);
            put_value(level.bytes, bits, 4);
        }
    }
    texture.levels.push_back(std::move(level));
    return texture;
}

// The result of reading `bytes`, packed again in `format`.
Bytes repack(const Image& image, Format format) {
    const FormatInfo info = format_info(format);
    Bytes bytes;
    for (int j = 0; j < image.extent().height; ++j) {
        for (int i = 0; i < image.extent().width; ++i) {
            for (const Plane<float>& plane : image.planes) {
                const float v = plane.at(i, j);
                if (info.sample == SampleKind::unorm) {
                    put_value(bytes, static_cast<std::uint32_t>(std::lround(v * (info.bits == 8 ? 255.0f : 65535.0f))),
                              info.bits / 8);
                } else if (info.bits == 16) {
                    put_value(bytes, static_cast<std::uint32_t>(std::lround((v - 0.5f) * 2048.0f)) + 0x3800, 2);
                } else {
                    std::uint32_t bits = 0;
                    std::memcpy(&bits, &v, 4);
                    put_value(bytes, bits, 4);
                }
            }
        }
    }
    return bytes;
}

TEST(ReaderEncode, WritesExactlyWhatItReads) {
    const std::pair<Container, Format> pairs[] = {
        {Container::tiff, Format::rgb8_unorm},  {Container::tiff, Format::rgba8_unorm},
        {Container::tiff, Format::rgb16_unorm}, {Container::tiff, Format::rgb16_float},
        {Container::tiff, Format::rgb32_float}, {Container::tiff, Format::r16_unorm},
        {Container::webp, Format::rgb8_unorm},  {Container::webp, Format::rgba8_unorm},
    };
    for (const auto& [container, format] : pairs) {
        SCOPED_TRACE(testing::Message() << name_of(kContainerNames, container) << " " << name_of(kFormatNames, format));
        const Texture texture = texture_of(format, {131, 67});
        const Result<Bytes> bytes = encode_with_reader(texture, container, quick_write());
        ASSERT_TRUE(bytes) << bytes.error().message();
        const Result<Image> image = read_encoded(*bytes);
        ASSERT_TRUE(image) << image.error().message();
        EXPECT_EQ(image->bits, format_info(format).bits);
        EXPECT_EQ(repack(*image, format), texture.levels.front().bytes);
    }
}

// WebP has no grey.
TEST(ReaderEncode, GreyFillsThreeChannelsOfWebp) {
    const Texture grey = texture_of(Format::r8_unorm, {33, 7});
    const Result<Bytes> bytes = encode_with_reader(grey, Container::webp, quick_write());
    ASSERT_TRUE(bytes) << bytes.error().message();
    const Result<Image> image = read_encoded(*bytes);
    ASSERT_TRUE(image) << image.error().message();
    ASSERT_EQ(image->planes.size(), 3u);
    for (const Plane<float>& plane : image->planes) {
        for (int i = 0; i < 33; ++i)
            EXPECT_EQ(static_cast<int>(std::lround(plane.at(i, 3) * 255.0f)),
                      static_cast<int>(grey.levels[0].bytes[static_cast<std::size_t>(3 * 33 + i)]));
    }
}

TEST(ReaderEncode, WebpThatEndsTooEarlyIsDamaged) {
    Bytes bytes = encode_with_reader(texture_of(Format::rgb8_unorm, {64, 64}), Container::webp, quick_write()).value();
    bytes.resize(bytes.size() / 2);
    const Result<Image> image = read_encoded(bytes);
    ASSERT_FALSE(image);
    EXPECT_EQ(image.error().code, ErrorCode::bad_data);
    EXPECT_EQ(image.error().reason, "damaged: the file ends too early");
}

TEST(ReaderEncode, WebpHasALongestSide) {
    const Result<Bytes> bytes =
        encode_with_reader(texture_of(Format::r8_unorm, {16384, 1}), Container::webp, quick_write());
    ASSERT_FALSE(bytes);
    EXPECT_EQ(bytes.error().code, ErrorCode::unsupported);
    EXPECT_EQ(bytes.error().reason, "webp holds at most 16383 texels a side");
}

TEST(ReaderEncode, JpegStaysClose) {
    Texture texture;
    texture.format = Format::rgb8_unorm;
    Level level{{64, 64}, {}};
    for (int j = 0; j < 64; ++j) {
        for (int i = 0; i < 64; ++i) {
            put_value(level.bytes, static_cast<std::uint32_t>(2 * i + 64), 1);
            put_value(level.bytes, static_cast<std::uint32_t>(2 * j + 64), 1);
            put_value(level.bytes, 240, 1);
        }
    }
    texture.levels.push_back(level);
    const Result<Bytes> bytes = encode_with_reader(texture, Container::jpeg, quick_write());
    ASSERT_TRUE(bytes) << bytes.error().message();
    const Result<Image> image = read_encoded(*bytes);
    ASSERT_TRUE(image) << image.error().message();
    for (int j = 0; j < 64; ++j) {
        for (int i = 0; i < 64; ++i) {
            EXPECT_NEAR(image->planes[0].at(i, j) * 255.0f, 2 * i + 64, 6);
            EXPECT_NEAR(image->planes[1].at(i, j) * 255.0f, 2 * j + 64, 6);
        }
    }
}

TEST(ReaderEncode, JpegIsTurnedAsItsExifSays) {
    Result<Bytes> bytes = encode_with_reader(texture_of(Format::rgb8_unorm, {64, 32}), Container::jpeg, quick_write());
    ASSERT_TRUE(bytes) << bytes.error().message();
    const std::string exif = std::string("Exif\0\0", 6) + exif_data(6, true);
    const std::string segment = std::string("\xff\xe1\0", 3) + static_cast<char>(exif.size() + 2) + exif;
    const auto* const added = reinterpret_cast<const std::byte*>(segment.data());
    bytes->insert(bytes->begin() + 2, added, added + segment.size());
    const Result<Image> image = read_encoded(*bytes);
    ASSERT_TRUE(image) << image.error().message();
    EXPECT_EQ(image->extent(), (Extent{32, 64}));
    EXPECT_EQ(image->remark, "the picture was turned or mirrored, as its orientation (6) says");
}

// Codes that were damaged leave bytes over before the end of the image. Padding does not count.
TEST(ReaderEncode, JpegWithBytesLeftOverIsDamaged) {
    const Result<Bytes> sound =
        encode_with_reader(texture_of(Format::rgb8_unorm, {64, 64}), Container::jpeg, quick_write());
    ASSERT_TRUE(sound) << sound.error().message();
    const auto with = [&](const std::string& more) {
        Bytes bytes = *sound;
        const auto* const added = reinterpret_cast<const std::byte*>(more.data());
        bytes.insert(bytes.end() - 2, added, added + more.size());
        return read_encoded(bytes);
    };
    EXPECT_TRUE(with("")) << with("").error().message();
    EXPECT_TRUE(with(std::string(32, '\0'))) << with(std::string(32, '\0')).error().message();
    const Result<Image> damaged = with("some codes");
    ASSERT_FALSE(damaged);
    EXPECT_EQ(damaged.error().code, ErrorCode::bad_data);
    EXPECT_NE(damaged.error().reason.find("extraneous bytes before marker 0xd9"), std::string::npos)
        << damaged.error().reason;
}

TEST(ReaderEncode, EqualTexturesGiveEqualBytesWithoutDates) {
    const Texture texture = texture_of(Format::rgb8_unorm, {16, 16});
    const Container containers[] = {Container::tiff, Container::jpeg, Container::webp};
    std::vector<Bytes> first;
    for (const Container container : containers)
        first.push_back(encode_with_reader(texture, container, quick_write()).value());
    usleep(1'100'000);  // long enough that a clock would show a different second
    for (std::size_t k = 0; k < first.size(); ++k) {
        EXPECT_EQ(encode_with_reader(texture, containers[k], quick_write()).value(), first[k]);
        const std::string text(reinterpret_cast<const char*>(first[k].data()), first[k].size());
        for (const char* trace : {"OpenImageIO", "oiio", "tex-reader", "/proc"}) {
            EXPECT_EQ(text.find(trace), std::string::npos) << trace;
        }
    }
}

TEST(ReaderEncode, RefusesWhatTheContainerCannotHold) {
    const std::pair<Container, Format> pairs[] = {
        {Container::jpeg, Format::rgba8_unorm}, {Container::webp, Format::rgb16_unorm},
        {Container::tga, Format::rgb16_unorm},  {Container::bmp, Format::rgb32_float},
        {Container::tiff, Format::bc3_unorm},   {Container::tiff, Format::rg8_unorm},
        {Container::png, Format::rgb8_unorm}};
    for (const auto& [container, format] : pairs) {
        const Result<Bytes> bytes = encode_with_reader(texture_of(format, {4, 4}), container, quick_write());
        ASSERT_FALSE(bytes);
        EXPECT_EQ(bytes.error().code, ErrorCode::unsupported) << bytes.error().reason;
    }
}

}  // namespace
}  // namespace tex
