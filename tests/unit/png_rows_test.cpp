// SPDX-License-Identifier: Apache-2.0
// libpng is the judge of how PNG files are read: the same files are refused, for the same reason, and the texels of the
// others are the same.

#include "formats/png/png_rows.h"

#include <zlib.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include <gtest/gtest.h>

#include "reference/png_file.h"
#include "unit/png_judge.h"

namespace tex {
namespace {

using reference::PngChunk;
using reference::PngHeader;

const std::string kData = TEX_SOURCE_DIR "/../shared/data/";

constexpr std::pair<unsigned, unsigned> kRowKinds[] = {{1, 0}, {2, 0}, {4, 0}, {8, 0}, {16, 0}, {8, 2}, {16, 2}, {1, 3},
                                                       {2, 3}, {4, 3}, {8, 3}, {8, 4}, {16, 4}, {8, 6}, {16, 6}};

// How texels are compressed. Strategies give blocks of every type: stored, with fixed and with dynamic codes.
struct Packing {
    int level = 6;
    int strategy = Z_DEFAULT_STRATEGY;
    int window_bits = 15;
};

constexpr Packing kPackings[] = {
    {6, Z_DEFAULT_STRATEGY, 15}, {0, Z_DEFAULT_STRATEGY, 15}, {1, Z_FIXED, 15}, {9, Z_HUFFMAN_ONLY, 15}, {6, Z_RLE, 15},
    {6, Z_FILTERED, 9}};

std::string packed(const std::string& bytes, const Packing& packing = {}) {
    z_stream stream{};
    EXPECT_EQ(deflateInit2(&stream, packing.level, Z_DEFLATED, packing.window_bits, 9, packing.strategy), Z_OK);
    std::string out(deflateBound(&stream, static_cast<uLong>(bytes.size())), '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
    out.resize(stream.total_out);
    deflateEnd(&stream);
    return out;
}

// Waves and noise; some texels are those that tRNS hides.
unsigned row_sample(const PngHeader& header, unsigned x, unsigned y, unsigned c) {
    const unsigned noise = (x * 40503u + y * 30011u + c * 7919u) >> 3 & 7u;
    return (x * 3 + y * 5 + c * 17 + noise * (header.bits == 16 ? 131 : 1)) & ((1u << header.bits) - 1);
}

std::string texels_of(const PngHeader& header, unsigned filter = 0) {
    return reference::png_texels(header, filter,
                                 [&](unsigned x, unsigned y, unsigned c) { return row_sample(header, x, y, c); });
}

std::string big_endian16(unsigned value) { return {static_cast<char>(value >> 8), static_cast<char>(value)}; }

// The chunks before the texels. A palette has fewer colours than indices.
std::vector<PngChunk> begin_of(const PngHeader& header, bool transparent) {
    std::vector<PngChunk> chunks = {reference::png_header(header)};
    if (header.color_type == 3) {
        std::string colors, alpha;
        for (unsigned k = 0; k < std::max(1u, (1u << header.bits) * 3 / 4); ++k) {
            colors += {static_cast<char>(k * 7), static_cast<char>(~k), '\x11'};
            alpha += k % 3 == 0 ? "" : std::string(1, static_cast<char>(k * 31));
        }
        chunks.push_back({"PLTE", colors});
        if (transparent) chunks.push_back({"tRNS", alpha.empty() ? "\x77" : alpha});
    } else if (transparent && header.color_type < 4) {
        std::string hidden;
        for (unsigned c = 0; c < reference::png_samples(header.color_type); ++c)
            hidden += big_endian16(row_sample(header, 0, 0, c));
        chunks.push_back({"tRNS", hidden});
    }
    return chunks;
}

// The IDAT chunks have `piece` bytes each; every third one is empty.
void add_data(std::vector<PngChunk>& chunks, const std::string& data, std::size_t piece) {
    for (std::size_t at = 0; at < data.size(); at += piece) {
        if (chunks.size() % 3 == 0 && piece < data.size()) chunks.push_back({"IDAT", ""});
        chunks.push_back({"IDAT", data.substr(at, piece)});
    }
}

std::vector<PngChunk> picture(const PngHeader& header, bool transparent = false, const Packing& packing = {},
                              std::size_t piece = 1 << 20, unsigned filter = 0) {
    std::vector<PngChunk> chunks = begin_of(header, transparent);
    add_data(chunks, packed(texels_of(header, filter), packing), piece);
    chunks.push_back({"IEND", ""});
    return chunks;
}

void expect_same(const std::string& file, const std::string& what) {
    const Verdict ours = our_verdict(file), theirs = libpng_verdict(file);
    EXPECT_EQ(ours.refused, theirs.refused) << what;
    EXPECT_TRUE(ours == theirs) << what;
}

// A file that libpng reads as well, but that is read without it.
void expect_plain(const std::vector<PngChunk>& chunks, const std::string& what) {
    const std::string file = reference::write_png(chunks);
    EXPECT_TRUE(is_plain_png(file)) << what;
    expect_same(file, what);
}

// A file that libpng has the last word on.
void expect_judged(const std::vector<PngChunk>& chunks, const std::string& what) {
    const std::string file = reference::write_png(chunks);
    EXPECT_FALSE(is_plain_png(file)) << what;
    expect_same(file, what);
}

std::string name_of_kind(const PngHeader& header, bool transparent) {
    return std::to_string(header.width) + "x" + std::to_string(header.height) + ", " + std::to_string(header.bits) +
           " bits, type " + std::to_string(header.color_type) + (transparent ? ", tRNS" : "");
}

TEST(PngRows, TexelsOfEveryKindAndSizeAreThoseOfLibpng) {
    unsigned k = 0;
    for (const auto& [bits, color_type] : kRowKinds) {
        for (const bool transparent : {false, true}) {
            for (unsigned size = 1; size <= 40; ++size, ++k) {
                const PngHeader header{size, 1 + (size * 7 + bits) % 40, bits, color_type, 0, 0, 0};
                const Packing& packing = kPackings[k % std::size(kPackings)];
                const std::size_t piece = k % 4 == 0 ? 1 + k % 11 : 1 << 20;
                if (color_type == 3 && transparent && bits == 1 && size > 2) continue;
                const std::vector<PngChunk> chunks = picture(header, transparent, packing, piece, k % 5);
                // libpng decides if the window of the stream is too small to hold all bytes.
                const bool holds_all = texels_of(header).size() <= 1u << packing.window_bits;
                (holds_all ? expect_plain : expect_judged)(chunks, name_of_kind(header, transparent));
            }
        }
    }
}

TEST(PngRows, LargerPicturesAreThoseOfLibpng) {
    unsigned k = 0;
    for (const auto& [bits, color_type] : kRowKinds) {
        for (const PngHeader& header :
             {PngHeader{700, 33, bits, color_type, 0, 0, 0}, PngHeader{90, 260, bits, color_type, 0, 0, 0}}) {
            Packing packing = kPackings[k++ % (std::size(kPackings) - 1)];
            expect_plain(picture(header, false, packing, 5000), name_of_kind(header, false));
            packing.window_bits = 9;
            expect_judged(picture(header, false, packing), name_of_kind(header, false));
        }
    }
    // Rows so long that few are unfiltered together.
    expect_plain(picture({60'000, 5, 16, 6, 0, 0, 0}), "long rows");
}

TEST(PngRows, InterlacedPicturesAreReadByLibpng) {
    for (const auto& [bits, color_type] : kRowKinds) {
        const std::string file = reference::write_png(picture({13, 9, bits, color_type, 0, 0, 1}, true));
        EXPECT_EQ(our_verdict(file).refused, "");
        expect_same(file, std::to_string(bits));
    }
}

// -- damage ------------------------------------------------------------------------------------------------

const PngHeader kPlain{23, 21, 8, 2, 0, 0, 0};

std::vector<PngChunk> plain_in_pieces() { return picture(kPlain, false, {}, 150); }

TEST(PngRows, EveryTruncationIsThatOfLibpng) {
    const std::string file = reference::write_png(plain_in_pieces());
    for (std::size_t size = 1; size < file.size(); ++size) expect_same(file.substr(0, size), std::to_string(size));
    expect_plain(plain_in_pieces(), "whole");
    EXPECT_TRUE(is_plain_png(file + "bytes after the end"));
    expect_same(file + "bytes after the end", "longer");
}

TEST(PngRows, EveryWrongBitIsThatOfLibpng) {
    const std::string file = reference::write_png(plain_in_pieces());
    for (std::size_t k = 0; k < file.size(); ++k) {
        std::string wrong = file;
        wrong[k] = static_cast<char>(wrong[k] ^ 1 << k % 8);
        EXPECT_FALSE(is_plain_png(wrong)) << k;
        expect_same(wrong, std::to_string(k));
    }
}

// The checksums of the chunks are right, so the damage reaches the inflater.
TEST(PngRows, EveryWrongByteOfCompressedTexelsIsThatOfLibpng) {
    for (const Packing& packing : kPackings) {
        const std::string data = packed(texels_of(kPlain), packing);
        std::mt19937 random(9);
        for (std::size_t k = 0; k < data.size(); k += 1 + k / 40) {
            std::string wrong = data;
            wrong[k] = static_cast<char>(wrong[k] ^ static_cast<char>(1 + random() % 255));
            std::vector<PngChunk> chunks = begin_of(kPlain, false);
            add_data(chunks, wrong, 300);
            chunks.push_back({"IEND", ""});
            expect_judged(chunks, std::to_string(k));
        }
    }
}

TEST(PngRows, EveryEndOfTheCompressedTexelsIsThatOfLibpng) {
    const std::string data = packed(texels_of(kPlain));
    for (std::size_t size = 0; size < data.size(); size += size < 20 || size + 20 > data.size() ? 1 : 17) {
        std::vector<PngChunk> chunks = begin_of(kPlain, false);
        chunks.push_back({"IDAT", data.substr(0, size)});
        chunks.push_back({"IEND", ""});
        expect_judged(chunks, std::to_string(size));
    }
    for (const std::string& more : {std::string(1, '\0'), std::string(4, 'x'), std::string(9000, '\x55'), data}) {
        for (const std::size_t piece : {std::size_t{1} << 20, data.size()}) {
            std::vector<PngChunk> chunks = begin_of(kPlain, false);
            add_data(chunks, data + more, piece);
            chunks.push_back({"IEND", ""});
            expect_judged(chunks, std::to_string(more.size()));
        }
    }
}

TEST(PngRows, TooManyAndTooFewTexelsAreThoseOfLibpng) {
    const std::string texels = texels_of(kPlain);
    for (const int change : {-200, -70, -1, 1, 2, 70, 40'000}) {
        std::string other = texels;
        other.resize(texels.size() + static_cast<std::size_t>(change), '\x03');
        std::vector<PngChunk> chunks = begin_of(kPlain, false);
        chunks.push_back({"IDAT", packed(other)});
        chunks.push_back({"IEND", ""});
        expect_judged(chunks, std::to_string(change));
    }
}

TEST(PngRows, WrongFiltersAreThoseOfLibpng) {
    const std::string texels = texels_of(kPlain);
    for (const int filter : {5, 6, 127, 255}) {
        for (const std::size_t row : {0u, 7u, 20u}) {
            std::string other = texels;
            other[row * (texels.size() / kPlain.height)] = static_cast<char>(filter);
            std::vector<PngChunk> chunks = begin_of(kPlain, false);
            chunks.push_back({"IDAT", packed(other)});
            chunks.push_back({"IEND", ""});
            expect_judged(chunks, std::to_string(filter));
        }
    }
}

// All first bytes of a zlib stream, with a right and a wrong check value.
TEST(PngRows, HeadersOfTheStreamAreThoseOfLibpng) {
    const PngHeader small{5, 5, 8, 0, 0, 0, 0};
    const std::string data = packed(texels_of(small));
    for (unsigned first = 0; first < 256; ++first) {
        for (const unsigned second : {0u, 0x20u, 0x80u, 0xa0u}) {
            for (const unsigned error : {0u, 1u}) {
                const unsigned rest = (first << 8 | second) % 31;
                std::string other = data;
                other[0] = static_cast<char>(first);
                other[1] = static_cast<char>(second + (rest == 0 ? 0 : 31 - rest) + error);
                std::vector<PngChunk> chunks = begin_of(small, false);
                add_data(chunks, other, first % 3 + 1);
                chunks.push_back({"IEND", ""});
                const std::string file = reference::write_png(chunks);
                EXPECT_EQ(is_plain_png(file), (first & 15) == 8 && first < 128 && (second & 0x20) == 0 && error == 0);
                expect_same(file, std::to_string(first));
            }
        }
    }
}

TEST(PngRows, ChunksOutOfPlaceAreThoseOfLibpng) {
    for (const PngHeader& header : {kPlain, PngHeader{9, 5, 4, 3, 0, 0, 0}, PngHeader{9, 5, 16, 0, 0, 0, 0}}) {
        const std::vector<PngChunk> plain = picture(header, true, {}, 60);
        for (std::size_t k = 0; k <= plain.size(); ++k) {
            for (const char* type : {"tEXt", "gAMA", "tRNS", "PLTE", "IHDR", "IEND", "IDAT", "cRIT", "CRIT", "aaa1"}) {
                for (const std::size_t size : {0u, 1u, 2u, 3u, 6u, 300u}) {
                    for (const std::uint32_t sum_error : {0u, 1u}) {
                        std::vector<PngChunk> chunks = plain;
                        chunks.insert(chunks.begin() + static_cast<std::ptrdiff_t>(k),
                                      {type, std::string(size, '\x01'), sum_error});
                        expect_same(reference::write_png(chunks), type + std::to_string(size));
                    }
                }
            }
        }
    }
}

TEST(PngRows, ChunksAfterTheTexelsAreSkippedIfTheirSumsAreRight) {
    std::vector<PngChunk> chunks = plain_in_pieces();
    chunks.insert(chunks.end() - 1, {"tEXt", std::string("date:create\0 2026", 17)});
    expect_plain(chunks, "text");
    chunks[chunks.size() - 2].sum_error = 1;
    expect_judged(chunks, "wrong sum");
    chunks = plain_in_pieces();
    chunks.back().data = "x";
    expect_judged(chunks, "an end with contents");
    chunks.pop_back();
    expect_judged(chunks, "no end");
}

// Puts numbers and Huffman codes in a row, as RFC 1951 says.
struct Bits {
    void number(unsigned value, int bits) {
        for (int k = 0; k < bits; ++k, ++count) {
            if (count % 8 == 0) bytes += '\0';
            bytes.back() = static_cast<char>(bytes.back() | static_cast<char>((value >> k & 1) << count % 8));
        }
    }
    void code(const char* pattern) {
        for (; *pattern != '\0'; ++pattern) number(*pattern == '1' ? 1 : 0, 1);
    }

    std::string bytes;
    int count = 0;
};

// The exception that png_texels.h names. The codes are 00 for a zero and 01 for the end; 1 is not used.
TEST(PngRows, CodesWithUnusedPatternsAreReadWithTheTexelsThatTheyMean) {
    for (const bool used : {false, true}) {
        Bits bits;
        bits.number(1, 1);  // the last block
        bits.number(2, 2);  // with dynamic codes
        bits.number(0, 5);  // for 257 literals and lengths
        bits.number(0, 5);  // and one distance
        bits.number(12, 4);
        // The lengths of the codes of lengths, in the order 16 17 18 0 8 7 9 6 10 5 11 4 12 3 13 2.
        for (const unsigned length : {0u, 0u, 1u, 2u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 2u})
            bits.number(length, 3);
        bits.code("11");  // 2 bits for the literal 0
        for (const unsigned zeros : {138u, 117u}) {
            bits.code("0");
            bits.number(zeros - 11, 7);
        }
        bits.code("11");  // 2 bits for the end
        bits.code("10");  // no distance
        bits.code(used ? "0010" : "0000");
        bits.code("01");
        const std::string data =
            "\x78\x01" + bits.bytes + reference::big_endian(reference::adler32(std::string(2, '\0')));
        const PngHeader header{1, 1, 8, 0, 0, 0, 0};
        const std::string file = reference::write_png({reference::png_header(header), {"IDAT", data}, {"IEND", ""}});
        EXPECT_EQ(libpng_verdict(file).refused, "a.png: damaged PNG: IDAT: invalid literal/lengths set");
        EXPECT_EQ(is_plain_png(file), !used);
        const Verdict ours = our_verdict(file);
        EXPECT_EQ(ours.refused, used ? libpng_verdict(file).refused : "");
        EXPECT_EQ(ours.rows, std::vector<std::byte>(used ? 0 : 1));
    }
}

// -- data --------------------------------------------------------------------------------------------------

TEST(PngRows, FilesOfOthersAreReadAsByLibpng) {
    if (!std::filesystem::exists(kData)) GTEST_SKIP() << "../shared/data is missing";
    int plain = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(kData)) {
        std::ifstream stream(entry.path(), std::ios::binary);
        char magic[4] = {};
        if (!entry.is_regular_file() || !stream.read(magic, 4) || std::string_view(magic, 4) != kPngMagic) continue;
        stream.seekg(0);
        const std::string file((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
        expect_same(file, entry.path());
        plain += is_plain_png(file) ? 1 : 0;
    }
    EXPECT_GT(plain, 20);
}

}  // namespace
}  // namespace tex
