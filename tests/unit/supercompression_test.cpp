// SPDX-License-Identifier: Apache-2.0
// KTX2 files whose levels are compressed. The levels are taken apart and put together with libzstd and zlib's format
// here, by other functions than libtex uses.

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <libdeflate.h>
#include <tex/file.h>
#include <zstd.h>

#include "files/input_file.h"
#include "formats/bytes.h"
#include "formats/texture_rows.h"
#include "unit/textures.h"

namespace tex {
namespace {

using Bytes = std::vector<std::byte>;
using testing::HasSubstr;

constexpr std::size_t kLevelsAt = 40, kSchemeAt = 44, kDescriptorAt = 48, kIndexAt = 80, kEntry = 24;

Bytes encode(const Texture& texture, int zstd = 0) {
    WriteOptions options;
    options.zstd = zstd;
    Result<Bytes> bytes = encode_file(texture, Container::ktx2, options);
    EXPECT_TRUE(bytes) << bytes.error().message();
    return bytes ? *bytes : Bytes{};
}

void set(Bytes& file, std::size_t at, std::uint64_t value, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) file[at + k] = static_cast<std::byte>(value >> (8 * k) & 0xff);
}

std::size_t levels_of(const Bytes& file) { return load_u32(file.data() + kLevelsAt); }

// The bytes of level k as the file stores them.
Bytes level_of(const Bytes& file, std::size_t k) {
    const std::byte* entry = file.data() + kIndexAt + k * kEntry;
    const auto first = file.begin() + static_cast<std::ptrdiff_t>(load_u64(entry));
    return {first, first + static_cast<std::ptrdiff_t>(load_u64(entry + 8))};
}

// The file with other levels.
Bytes with_levels(Bytes file, const std::vector<Bytes>& levels, std::uint32_t scheme) {
    for (std::size_t k = 0; k < levels.size(); ++k) {
        set(file, kIndexAt + k * kEntry, file.size(), 8);
        set(file, kIndexAt + k * kEntry + 8, levels[k].size(), 8);
        file.insert(file.end(), levels[k].begin(), levels[k].end());
    }
    set(file, kSchemeAt, scheme, 4);
    return file;
}

Bytes zstd(const Bytes& bytes, bool with_size = true) {
    ZSTD_CCtx* const context = ZSTD_createCCtx();
    ZSTD_CCtx_setParameter(context, ZSTD_c_contentSizeFlag, with_size ? 1 : 0);
    ZSTD_CCtx_setParameter(context, ZSTD_c_checksumFlag, 1);
    Bytes packed(ZSTD_compressBound(bytes.size()));
    packed.resize(ZSTD_compress2(context, packed.data(), packed.size(), bytes.data(), bytes.size()));
    ZSTD_freeCCtx(context);
    return packed;
}

Bytes zlib(const Bytes& bytes) {
    libdeflate_compressor* const compressor = libdeflate_alloc_compressor(6);
    Bytes packed(libdeflate_zlib_compress_bound(compressor, bytes.size()));
    packed.resize(libdeflate_zlib_compress(compressor, bytes.data(), bytes.size(), packed.data(), packed.size()));
    libdeflate_free_compressor(compressor);
    return packed;
}

std::vector<Bytes> all_levels(const Bytes& file, const std::function<Bytes(const Bytes&)>& change) {
    std::vector<Bytes> levels;
    for (std::size_t k = 0; k < levels_of(file); ++k) levels.push_back(change(level_of(file, k)));
    return levels;
}

// The bytes of a level, decoded in rows.
Result<Bytes> in_rows(RowSource& level, Format format) {
    Bytes bytes;
    for (int j = 0; j < level.extent().height; j += level.rows_together()) {
        const int count = std::min(level.rows_together(), level.extent().height - j);
        const std::size_t before = bytes.size();
        const int rows = level.rows_together() == 1 ? count : level.rows_together();
        bytes.resize(before + level.row_bytes() * static_cast<std::size_t>(rows));
        if (const Result<void> done = level.decode(j, count, bytes.data() + before); !done) return done.error();
        bytes.resize(before + level_bytes(format, {level.extent().width, rows}));  // row_bytes() is rounded up
    }
    return bytes;
}

// Reads a file at once and in rows. Both must agree.
Result<Texture> read(const Bytes& bytes) {
    Result<Texture> texture = read_texture(bytes, "test.ktx2");
    Result<InputFile> file = InputFile::from_memory("test.ktx2", bytes);
    if (!file) return file.error();
    const Result<TextureRows> rows = open_texture_rows(*file, {});
    if (!rows) {
        EXPECT_FALSE(texture);
        return rows.error();
    }
    for (std::size_t k = 0; k < rows->levels.size(); ++k) {
        const Result<Bytes> level = in_rows(*rows->levels[k], rows->head.format);
        EXPECT_EQ(bool(level), bool(texture));
        if (level && texture) {
            EXPECT_EQ(*level, texture->levels[k].bytes) << "level " << k;
        } else if (!level && !texture) {
            EXPECT_EQ(level.error().message(), texture.error().message());
        }
    }
    return texture;
}

void expect_same_levels(const Texture& texture, const Texture& wanted) {
    ASSERT_EQ(texture.levels.size(), wanted.levels.size());
    for (std::size_t k = 0; k < wanted.levels.size(); ++k)
        EXPECT_EQ(texture.levels[k].bytes, wanted.levels[k].bytes) << "level " << k;
}

void expect_refused(const Bytes& bytes, ErrorCode code, const std::string& reason) {
    const auto texture = read(bytes);
    ASSERT_FALSE(texture) << reason;
    EXPECT_EQ(texture.error().code, code);
    EXPECT_EQ(texture.error().file, "test.ktx2");
    EXPECT_THAT(texture.error().reason, HasSubstr(reason));
}

TEST(Supercompression, IsTheSameTextureInEveryFormat) {
    for (const auto& row : kFormatNames) {
        if (!can_hold(Container::ktx2, row.value)) continue;
        const Texture texture = patterned_texture(row.value, {61, 34}, 6);
        const Bytes plain = encode(texture);
        const auto wanted = read(plain);
        ASSERT_TRUE(wanted);
        for (const int level : {1, 9, 22}) {
            const Bytes file = encode(texture, level);
            const auto got = read(file);
            ASSERT_TRUE(got) << row.name << ": " << got.error().message();
            expect_same_levels(*got, *wanted);
            EXPECT_EQ(got->swizzle, wanted->swizzle);
            EXPECT_EQ(encode(texture, level), file);
        }
    }
}

// KTX 2.0, 3.2 and 5.2: the smallest level comes first, without padding; uncompressed sizes stay in the level index;
// the descriptor's bytesPlane0 is 0. Each level is one frame that states its size.
TEST(Supercompression, FollowsTheSpecification) {
    const Bytes plain = encode(patterned_texture(Format::bc5_unorm, {64, 64}, 7));
    const Bytes file = encode(patterned_texture(Format::bc5_unorm, {64, 64}, 7), 9);
    EXPECT_EQ(load_u32(file.data() + kSchemeAt), 2u);
    EXPECT_EQ(file[load_u32(file.data() + kDescriptorAt) + 20], std::byte{0});
    EXPECT_EQ(plain[load_u32(plain.data() + kDescriptorAt) + 20], std::byte{16});
    std::size_t end = file.size();
    for (std::size_t k = 0; k < 7; ++k) {
        const std::byte* entry = file.data() + kIndexAt + k * kEntry;
        const Bytes packed = level_of(file, k);
        EXPECT_EQ(load_u64(entry) + packed.size(), end);
        end = load_u64(entry);
        const Bytes wanted = level_of(plain, k);
        EXPECT_EQ(load_u64(entry + 16), wanted.size());
        EXPECT_EQ(ZSTD_getFrameContentSize(packed.data(), packed.size()), wanted.size());
        Bytes unpacked(wanted.size() + 1);
        unpacked.resize(ZSTD_decompress(unpacked.data(), unpacked.size(), packed.data(), packed.size()));
        EXPECT_EQ(unpacked, wanted);
    }
}

TEST(Supercompression, FramesOfOthersAreRead) {
    const Texture texture = patterned_texture(Format::rgba8_unorm, {300, 200}, 3);
    const Bytes plain = encode(texture);
    const auto wanted = read(plain);
    for (const auto& file :
         {with_levels(plain, all_levels(plain, [](const Bytes& level) { return zstd(level); }), 2),
          with_levels(plain, all_levels(plain, [](const Bytes& level) { return zstd(level, false); }), 2),
          with_levels(plain, all_levels(plain, zlib), 3)}) {
        const auto got = read(file);
        ASSERT_TRUE(got) << got.error().message();
        expect_same_levels(*got, *wanted);
        EXPECT_EQ(got->zlib, file == with_levels(plain, all_levels(plain, zlib), 3));
    }
    EXPECT_FALSE(wanted->zlib);
}

// Rows that run upwards are read from the end of the level.
TEST(Supercompression, RowsMayRunUpwards) {
    Bytes plain = encode(patterned_texture(Format::rgba8_unorm, {40, 30}, 1));
    const auto down = std::search(plain.begin(), plain.end(), reinterpret_cast<const std::byte*>("rd"),
                                  reinterpret_cast<const std::byte*>("rd") + 3);
    ASSERT_NE(down, plain.end());
    down[1] = std::byte{'u'};
    const auto wanted = read(plain);
    const auto got = read(with_levels(plain, all_levels(plain, [](const Bytes& level) { return zstd(level); }), 2));
    ASSERT_TRUE(wanted && got);
    expect_same_levels(*got, *wanted);
}

TEST(Supercompression, DamagedLevelsAreRefused) {
    const Bytes plain = encode(patterned_texture(Format::bc5_unorm, {256, 256}, 1));
    const Bytes level = level_of(plain, 0);
    const Bytes good = zstd(level);
    const auto file = [&](const Bytes& packed, std::uint32_t scheme = 2) {
        return with_levels(plain, {packed}, scheme);
    };
    ASSERT_TRUE(read(file(good)));
    const auto joined = [](Bytes first, const Bytes& second) {
        first.insert(first.end(), second.begin(), second.end());
        return first;
    };
    const Bytes longer = joined(level, {std::byte{1}});
    const Bytes shorter(level.begin(), level.end() - 1);
    const Bytes skippable = {std::byte{0x50}, std::byte{0x2a}, std::byte{0x4d}, std::byte{0x18},
                             std::byte{0},    std::byte{0},    std::byte{0},    std::byte{0}};
    Bytes with_dictionary = good;
    with_dictionary[4] |= std::byte{1};
    Bytes damaged = good;
    damaged[good.size() / 2] ^= std::byte{0x40};
    Bytes truncated(good.begin(), good.end() - 7);
    constexpr ErrorCode kBad = ErrorCode::bad_data;
    expect_refused(file(zstd(longer)), kBad, "compressed level: holds too many bytes");
    expect_refused(file(zstd(shorter)), kBad, "compressed level: holds too few bytes");
    expect_refused(file(joined(good, good)), kBad, "compressed level: data after the frame");
    expect_refused(file(joined(good, {std::byte{0}})), kBad, "compressed level: data after the frame");
    expect_refused(file(joined(skippable, good)), kBad, "compressed level: no Zstandard frame");
    expect_refused(file(with_dictionary), ErrorCode::unsupported, "dictionary");
    expect_refused(file(damaged), kBad, "compressed level: ");
    expect_refused(file(truncated), kBad, "compressed level: the data end too early");
    expect_refused(file(level), kBad, "compressed level: no Zstandard frame");
    expect_refused(file(zlib(longer), 3), kBad, "not the ZLIB data of this level");
    expect_refused(file(zlib(shorter), 3), kBad, "not the ZLIB data of this level");
    expect_refused(file(joined(zlib(level), level), 3), kBad, "not the ZLIB data of this level");
    expect_refused(file(good, 3), kBad, "not the ZLIB data of this level");
}

// A file of a few bytes cannot claim a level of many.
TEST(Supercompression, BombsAreRefusedBeforeMemoryIsAllocated) {
    Bytes file = with_levels(encode(patterned_texture(Format::rgba8_unorm, {4, 4}, 1)), {Bytes(20)}, 2);
    set(file, 20, 16384, 4);
    set(file, 24, 16384, 4);
    set(file, kIndexAt + 16, std::uint64_t{16384} * 16384 * 4, 8);
    expect_refused(file, ErrorCode::bad_data, "claims 16384x16384 texels, more than its 20 bytes can hold");
}

TEST(Supercompression, OthersAreUnsupported) {
    Bytes file = encode(patterned_texture(Format::rgba8_unorm, {4, 4}, 1));
    set(file, kSchemeAt, 1, 4);
    expect_refused(file, ErrorCode::bad_data, "BasisLZ holds no texels of VkFormat 37");
    set(file, kSchemeAt, 9, 4);
    expect_refused(file, ErrorCode::unsupported, "supercompression scheme 9 is not supported");
}

TEST(Supercompression, OtherContainersAndLevelsAreErrors) {
    const Texture texture = patterned_texture(Format::rgba8_unorm, {4, 4}, 1);
    WriteOptions options;
    options.zstd = 3;
    for (const auto& row : kContainerNames) {
        const auto bytes = encode_file(texture, row.value, options);
        EXPECT_EQ(bool(bytes), can_compress(row.value)) << row.name;
        if (!bytes) {
            EXPECT_EQ(bytes.error().code, ErrorCode::unsupported) << row.name;
        }
    }
    for (const int level : {-1, 23}) {
        options.zstd = level;
        const auto bytes = encode_file(texture, Container::ktx2, options);
        ASSERT_FALSE(bytes);
        EXPECT_EQ(bytes.error().code, ErrorCode::bad_option);
    }
}

}  // namespace
}  // namespace tex
