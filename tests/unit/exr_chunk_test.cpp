// SPDX-License-Identifier: Apache-2.0

#include "formats/exr/exr_chunk.h"

#include <gtest/gtest.h>

#include <malloc.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <random>

#include <ImfCompression.h>

#include "formats/exr/exr_rows.h"
#include "unit/exr_files.h"

namespace tex {
namespace {

using Bytes = std::vector<std::byte>;

constexpr Imf::Compression kOwn[] = {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION,
                                     Imf::ZIP_COMPRESSION};

TEST(ExrChunk, RunsAreCounted) {
    const Bytes bytes = {std::byte{9}, std::byte{1}, std::byte{0xfd},
                         std::byte{1}, std::byte{2}, std::byte{3}};  // 10 times 1, then 3 bytes
    ChunkDecoder decoder;
    EXPECT_EQ(decoder.texels(Imf::RLE_COMPRESSION, bytes, 13, 13).size(), 13u);
    EXPECT_EQ(decoder.texels(Imf::RLE_COMPRESSION, bytes, 12, 13).size(), 12u);
    EXPECT_TRUE(decoder.texels(Imf::RLE_COMPRESSION, bytes, 14, 14).empty());
    EXPECT_TRUE(decoder.texels(Imf::RLE_COMPRESSION, bytes, 12, 12).empty()) << "more than the texels of a chunk";
    EXPECT_TRUE(decoder.texels(Imf::RLE_COMPRESSION, std::span(bytes).first(5), 13, 13).empty());
}

TEST(ExrChunk, EmptyOnesAreNeverWhole) {
    const Bytes stored(8);
    ChunkDecoder decoder;
    for (const Imf::Compression compression : kOwn) {
        EXPECT_TRUE(decoder.texels(compression, {}, 8, 8).empty()) << compression;
        EXPECT_EQ(decoder.texels(compression, stored, 8, 8).size(), 8u) << compression;
    }
    EXPECT_TRUE(decoder.texels(Imf::NO_COMPRESSION, std::span(stored).first(7), 8, 8).empty());
}

// The result of reading a file with these bytes while new memory is filled with `poison` (the C library's M_PERTURB).
std::string read_poisoned(const Bytes& bytes, int poison) {
    mallopt(M_PERTURB, poison);
    std::string said;
    const Result<InputFile> opened = InputFile::from_memory("test.exr", bytes);
    InputFile& file = const_cast<InputFile&>(opened.value());
    const Result<Image> image = read_all(open_exr_rows(file, {}));
    if (!image) said = image.error().reason;
    for (std::size_t c = 0; image && c < image->planes.size(); ++c) {
        for (int j = 0; j < image->extent().height; ++j) {
            said.append(reinterpret_cast<const char*>(image->planes[c].row(j)),
                        static_cast<std::size_t>(image->extent().width) * sizeof(float));
        }
    }
    mallopt(M_PERTURB, 0);
    return said;
}

// (The address sanitizer has its own allocator, which M_PERTURB does not affect. With it this test finds other errors.)
TEST(ExrChunk, DamagedFilesReadTheSameWhateverMemoryHeldBefore) {
    std::minstd_rand random(7);
    int read = 0;
    for (int k = 0; k < Imf::NUM_COMPRESSION_METHODS; ++k) {
        for (const bool tiled : {false, true}) {
            const Bytes sound = exr_file({37, 41}, {"G", "R", "B"}, Imf::HALF, static_cast<Imf::Compression>(k), tiled);
            const bool own = std::find(std::begin(kOwn), std::end(kOwn), k) != std::end(kOwn);
            for (int round = 0; round < (own ? 120 : 8); ++round) {  // the others start a process
                Bytes bytes = sound;
                // Chunks with a different length or different bytes; the header stays.
                constexpr std::size_t kHeader = 300;
                for (std::size_t n = random() % 3 + 1; n > 0; --n) {
                    bytes[kHeader + random() % (bytes.size() - kHeader)] =
                        static_cast<std::byte>(random() % 4 == 0 ? 0 : random());
                }
                const std::string first = read_poisoned(bytes, 0x55);
                read += first.size() > 200;
                const bool same = first == read_poisoned(bytes, 0xaa);
                EXPECT_TRUE(same) << "compression " << k << (tiled ? ", tiled, " : ", ") << round;
            }
        }
    }
    EXPECT_GT(read, 100);
}

}  // namespace
}  // namespace tex
