// SPDX-License-Identifier: Apache-2.0

#include <png.h>

#include <atomic>
#include <cmath>
#include <csetjmp>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <optional>
#include <random>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <tex/pipeline.h>

#include "formats/png/png.h"
#include "reference/real_maps.h"
#include "unit/streams.h"

namespace tex {
namespace {

const std::string kSharedData = TEX_SOURCE_DIR "/../shared/data/";

const std::vector<Format> kPngFormats = {Format::r8_unorm,  Format::rgb8_unorm,  Format::rgba8_unorm,
                                         Format::r16_unorm, Format::rgb16_unorm, Format::rgba16_unorm};

// Waves with some noise: texels that filters predict, and rows for which different filters are best.
Texture wavy(Format format, Extent extent) {
    const FormatInfo info = format_info(format);
    Texture texture;
    texture.format = format;
    Level level{extent, Bytes(level_bytes(format, extent))};
    std::mt19937 random(7);
    std::size_t at = 0;
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            for (int c = 0; c < info.channels; ++c) {
                const double wave = std::sin(0.05 * i + c) * std::cos(0.07 * j) * (j % 3 == 0 ? 0.1 : 0.4) + 0.5;
                const auto code =
                    static_cast<unsigned>(wave * ((1 << info.bits) - 1)) + static_cast<unsigned>(random() % 3);
                for (int k = 0; k < info.bits / 8; ++k) level.bytes[at++] = static_cast<std::byte>(code >> 8 * k);
            }
        }
    }
    texture.levels.push_back(std::move(level));
    return texture;
}

// libpng as a judge and as the writer that we are compared with.
struct Libpng {
    png_structp png = nullptr;
    png_infop info = nullptr;
    Bytes bytes;
    std::size_t at = 0;
    std::string problem;

    static void on_problem(png_structp p, png_const_charp message) {
        static_cast<Libpng*>(png_get_error_ptr(p))->problem += message;
    }
    static void on_error(png_structp p, png_const_charp message) {
        on_problem(p, message);
        png_longjmp(p, 1);
    }
    static void on_read(png_structp p, png_bytep to, std::size_t count) {
        auto* file = static_cast<Libpng*>(png_get_io_ptr(p));
        if (count > file->bytes.size() - file->at) png_error(p, "the file ends");
        std::memcpy(to, file->bytes.data() + file->at, count);
        file->at += count;
    }
    static void on_write(png_structp p, png_bytep from, std::size_t count) {
        auto* file = static_cast<Libpng*>(png_get_io_ptr(p));
        const auto* begin = reinterpret_cast<const std::byte*>(from);
        file->bytes.insert(file->bytes.end(), begin, begin + count);
    }
};

// The texels, without any warning; little-endian.
bool decode(Libpng& file, Bytes& texels) {
    file.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &file, Libpng::on_error, Libpng::on_problem);
    file.info = png_create_info_struct(file.png);
    if (setjmp(png_jmpbuf(file.png))) return false;
    png_set_read_fn(file.png, &file, Libpng::on_read);
    png_set_user_limits(file.png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_read_info(file.png, file.info);
    if (png_get_bit_depth(file.png, file.info) == 16) png_set_swap(file.png);
    const std::size_t row_bytes = png_get_rowbytes(file.png, file.info);
    const png_uint_32 height = png_get_image_height(file.png, file.info);
    texels.resize(row_bytes * height);
    for (png_uint_32 j = 0; j < height; ++j) {
        png_read_row(file.png, reinterpret_cast<png_bytep>(texels.data() + j * row_bytes), nullptr);
    }
    png_read_end(file.png, nullptr);
    return true;
}

// What libpng writes with the same filters and run lengths.
std::size_t size_by_libpng(const Texture& texture) {
    const FormatInfo info = format_info(texture.format);
    const Level& level = texture.levels.front();
    Libpng file;
    file.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &file, Libpng::on_error, Libpng::on_problem);
    file.info = png_create_info_struct(file.png);
    if (setjmp(png_jmpbuf(file.png))) return 0;
    png_set_write_fn(file.png, &file, Libpng::on_write, nullptr);
    const int type = info.channels == 1   ? PNG_COLOR_TYPE_GRAY
                     : info.channels == 3 ? PNG_COLOR_TYPE_RGB
                                          : PNG_COLOR_TYPE_RGBA;
    png_set_compression_strategy(file.png, 3);  // Z_RLE
    png_set_filter(file.png, PNG_FILTER_TYPE_BASE, PNG_ALL_FILTERS);
    png_set_IHDR(file.png, file.info, static_cast<png_uint_32>(level.extent.width),
                 static_cast<png_uint_32>(level.extent.height), info.bits, type, PNG_INTERLACE_NONE, 0, 0);
    png_write_info(file.png, file.info);
    if (info.bits == 16) png_set_swap(file.png);
    const std::size_t row_bytes = level.bytes.size() / static_cast<std::size_t>(level.extent.height);
    for (std::size_t at = 0; at < level.bytes.size(); at += row_bytes) {
        png_write_row(file.png, reinterpret_cast<png_const_bytep>(level.bytes.data() + at));
    }
    png_write_end(file.png, file.info);
    png_destroy_write_struct(&file.png, &file.info);
    return file.bytes.size();
}

// Every chunk up to the end is whole, and IDAT chunks are neighbours.
void expect_chunks(const Bytes& bytes) {
    std::string types;
    std::size_t at = 8;
    while (at + 12 <= bytes.size()) {
        std::size_t length = 0;
        for (std::size_t k = 0; k < 4; ++k) length = length << 8 | std::to_integer<std::size_t>(bytes[at + k]);
        types += std::to_integer<char>(bytes[at + 5]);
        at += 12 + length;
    }
    EXPECT_EQ(at, bytes.size());
    EXPECT_EQ(types, "H" + std::string(types.size() - 2, 'D') + "E");
}

void expect_decodes(const Texture& texture) {
    const Extent extent = texture.levels.front().extent;
    SCOPED_TRACE(std::string(name_of(kFormatNames, texture.format)) + " " + std::to_string(extent.width) + "x" +
                 std::to_string(extent.height));
    const Result<Bytes> bytes = encode_png(texture);
    ASSERT_TRUE(bytes) << bytes.error().message();
    expect_chunks(*bytes);
    Libpng file;
    file.bytes = *bytes;
    Bytes texels;
    EXPECT_TRUE(decode(file, texels));
    EXPECT_EQ(file.problem, "");
    EXPECT_EQ(file.at, bytes->size());
    EXPECT_TRUE(texels == texture.levels.front().bytes);
    png_destroy_read_struct(&file.png, &file.info, nullptr);
}

TEST(PngWrite, LibpngDecodesTheSameTexels) {
    for (const Format format : kPngFormats) {
        // One texel, one row, one column, one and several blocks, and rows longer than a block.
        for (const Extent extent : {Extent{1, 1}, Extent{200, 1}, Extent{1, 3000}, Extent{33, 7}, Extent{300, 700},
                                    Extent{140'000, 1}, Extent{140'000, 3}}) {
            expect_decodes(wavy(format, extent));
        }
    }
}

// Zeros give the longest runs; noise cannot be compressed.
TEST(PngWrite, LibpngDecodesTexelsOfEveryDensity) {
    std::mt19937 random(3);
    for (const int share : {0, 1, 50, 1000}) {
        Texture texture = wavy(Format::rgb8_unorm, {500, 600});
        for (std::byte& b : texture.levels.front().bytes) {
            b = random() % 1000 < static_cast<unsigned>(share) ? static_cast<std::byte>(random()) : std::byte{0};
        }
        expect_decodes(texture);
    }
}

// Puts rows in pieces of several sizes, and ends work in any order on several threads.
Result<Bytes> encode_with(int threads, const Texture& texture) {
    Bytes file;
    const Level& level = texture.levels.front();
    Result<std::unique_ptr<RowTarget>> target =
        open_png_target(head_of(texture), [&](std::uint64_t offset, std::span<const std::byte> bytes) -> Result<void> {
            file.resize(std::max(file.size(), static_cast<std::size_t>(offset) + bytes.size()));
            std::copy(bytes.begin(), bytes.end(), file.begin() + static_cast<std::ptrdiff_t>(offset));
            return {};
        });
    if (!target) return target.error();
    std::mutex mutex;
    std::atomic<bool> failed{false};
    const std::size_t row_bytes = level.bytes.size() / static_cast<std::size_t>(level.extent.height);
    int next = 0;
    const auto work = [&](int k) {
        std::unique_lock lock(mutex);
        while (next < level.extent.height) {
            const int count = std::min(1 + k * 13, level.extent.height - next);
            if (!(*target)->put(0, level.bytes.data() + static_cast<std::size_t>(next) * row_bytes, count))
                failed = true;
            next += count;
            while (const std::shared_ptr<RowWork> some = (*target)->take_work()) {
                lock.unlock();
                if (!some->run()) failed = true;
                lock.lock();
                if (!(*target)->end_work(some)) failed = true;
            }
        }
    };
    std::vector<std::thread> others;
    for (int k = 1; k < threads; ++k) others.emplace_back(work, k);
    work(0);
    for (std::thread& other : others) other.join();
    EXPECT_FALSE(failed);
    if (const Result<void> ended = (*target)->finish(); !ended) return ended.error();
    return file;
}

TEST(PngWrite, BytesDoNotDependOnThreads) {
    for (const Format format : kPngFormats) {
        const Texture texture = wavy(format, {700, 900});
        const Result<Bytes> expected = encode_png(texture);
        ASSERT_TRUE(expected);
        for (const int threads : {1, 2, 5}) {
            const Result<Bytes> bytes = encode_with(threads, texture);
            ASSERT_TRUE(bytes);
            EXPECT_TRUE(*bytes == *expected) << name_of(kFormatNames, format) << ", " << threads << " threads";
        }
    }
}

TEST(PngWrite, MissingRowsAreAnError) {
    const Texture texture = wavy(Format::rgb8_unorm, {10, 10});
    Result<std::unique_ptr<RowTarget>> target =
        open_png_target(head_of(texture), [](std::uint64_t, std::span<const std::byte>) { return Result<void>(); });
    ASSERT_TRUE(target);
    ASSERT_TRUE((*target)->put(0, texture.levels.front().bytes.data(), 9));
    EXPECT_EQ((*target)->take_work(), nullptr);
    EXPECT_FALSE((*target)->finish());
}

TEST(PngWrite, TakesNoMoreBytesThanLibpngOnRealMaps) {
    if (!std::filesystem::exists(kSharedData)) GTEST_SKIP() << "../shared/data is missing";
    std::size_t ours = 0, theirs = 0;
    for (const reference::RealMap& map : reference::real_maps()) {
        const Result<Image> image = read_image(kSharedData + map.path);
        if (!image || image->bits != 8 || image->planes.size() < 3) continue;
        Texture texture;
        texture.format = Format::rgb8_unorm;
        Level level{image->extent(), {}};
        for (int j = 0; j < level.extent.height; ++j) {
            for (int i = 0; i < level.extent.width; ++i) {
                for (std::size_t c = 0; c < 3; ++c)
                    level.bytes.push_back(static_cast<std::byte>(std::lround(image->planes[c].at(i, j) * 255.0f)));
            }
        }
        texture.levels.push_back(std::move(level));
        const Result<Bytes> bytes = encode_png(texture);
        ASSERT_TRUE(bytes) << map.path;
        const std::size_t other = size_by_libpng(texture);
        // A flat map of 4 KB has more tables of codes than from libpng: one for each block.
        EXPECT_LE(static_cast<double>(bytes->size()), 1.01 * static_cast<double>(other) + 1024.0) << map.path;
        ours += bytes->size();
        theirs += other;
    }
    EXPECT_GT(ours, 0u);
    EXPECT_LE(ours, theirs);
    RecordProperty("bytes", std::to_string(ours) + " of " + std::to_string(theirs));
}

}  // namespace
}  // namespace tex
