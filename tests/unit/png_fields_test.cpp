// SPDX-License-Identifier: Apache-2.0
// Every type of PNG, with legal and illegal values in every field, written without libpng. The file must be read
// correctly or refused.

#include "reference/png_file.h"

#include <gtest/gtest.h>

#include "formats/png/png.h"

namespace tex {
namespace {

using reference::PngChunk;
using reference::PngHeader;

constexpr std::pair<unsigned, unsigned> kKinds[] = {{1, 0}, {2, 0}, {4, 0}, {8, 0}, {16, 0}, {8, 2}, {16, 2}, {1, 3},
                                                    {2, 3}, {4, 3}, {8, 3}, {8, 4}, {16, 4}, {8, 6}, {16, 6}};

unsigned sample_of(const PngHeader& header, unsigned x, unsigned y, unsigned c) {
    return (x * 40503u + y * 30011u + c * 7919u) & ((1u << header.bits) - 1);
}

std::vector<PngChunk> picture(const PngHeader& header, unsigned filter) {
    std::vector<PngChunk> chunks = {reference::png_header(header)};
    if (header.color_type == 3) {
        std::string colors;
        for (unsigned k = 0; k < 1u << header.bits; ++k)
            colors += {static_cast<char>(k), static_cast<char>(~k), '\x11'};
        chunks.push_back({"PLTE", colors});
    }
    const std::string texels = reference::png_texels(
        header, filter, [&](unsigned x, unsigned y, unsigned c) { return sample_of(header, x, y, c); });
    const std::string packed = reference::stored(texels);
    chunks.push_back({"IDAT", packed.substr(0, packed.size() / 3)});
    chunks.push_back({"IDAT", packed.substr(packed.size() / 3)});
    chunks.push_back({"IEND", ""});
    return chunks;
}

Result<Image> read(const std::vector<PngChunk>& chunks) {
    const std::string text = reference::write_png(chunks);
    const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
    Result<InputFile> file = InputFile::from_memory("a.png", {bytes, bytes + text.size()});
    ReadOptions options;
    options.max_texels = 1 << 20;
    return read_all(open_png(*file, options));
}

void expect_read_or_refused(const std::vector<PngChunk>& chunks) {
    const Result<Image> image = read(chunks);
    if (image) return;
    EXPECT_FALSE(image.error().reason.empty());
    EXPECT_TRUE(image.error().code == ErrorCode::bad_data || image.error().code == ErrorCode::unsupported);
}

}  // namespace

TEST(PngFields, EveryKindIsReadWithEveryFilterAndInterlaced) {
    for (const auto& [bits, color_type] : kKinds) {
        for (const unsigned interlace : {0u, 1u}) {
            for (const auto& [width, height] : {std::pair{1u, 1u}, std::pair{3u, 7u}, std::pair{19u, 11u}}) {
                for (unsigned filter = 0; filter < 5; ++filter) {
                    PngHeader header{width, height, bits, color_type, 0, 0, interlace};
                    SCOPED_TRACE(testing::Message()
                                 << bits << " bits, type " << color_type << ", interlace " << interlace << ", " << width
                                 << "x" << height << ", filter " << filter);
                    const Result<Image> image = read(picture(header, filter));
                    ASSERT_TRUE(image) << image.error().message();
                    ASSERT_EQ(image->planes.size(), color_type == 3 ? 3u : reference::png_samples(color_type));
                    for (unsigned y = 0; y < height; ++y) {
                        for (unsigned x = 0; x < width; ++x) {
                            for (unsigned c = 0; c < image->planes.size(); ++c) {
                                const unsigned code = sample_of(header, x, y, color_type == 3 ? 0 : c);
                                const unsigned color[] = {code, ~code & 0xff, 0x11};
                                const double expected =
                                    color_type == 3 ? color[c] / 255.0 : code / static_cast<double>((1u << bits) - 1);
                                ASSERT_EQ(image->planes[c].at(static_cast<int>(x), static_cast<int>(y)),
                                          static_cast<float>(expected))
                                    << x << ", " << y << ", " << c;
                            }
                        }
                    }
                }
            }
        }
    }
}

TEST(PngFields, HeadersOfAllValuesAreReadOrRefused) {
    const PngHeader plain{5, 3, 8, 2, 0, 0, 0};
    for (const unsigned value : {0u, 1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u, 9u, 15u, 16u, 17u, 32u, 64u, 127u, 128u, 255u}) {
        for (unsigned PngHeader::*field : {&PngHeader::bits, &PngHeader::color_type, &PngHeader::compression,
                                           &PngHeader::filter, &PngHeader::interlace}) {
            PngHeader header = plain;
            header.*field = value;
            auto chunks = picture(plain, 1);
            chunks[0] = reference::png_header(header);
            expect_read_or_refused(chunks);
        }
    }
    for (const std::uint32_t value : {0u, 1u, 4u, 6u, 0xffffu, 0x10000u, 0x7fffffffu, 0x80000000u, 0xffffffffu}) {
        for (std::uint32_t PngHeader::*field : {&PngHeader::width, &PngHeader::height}) {
            PngHeader header = plain;
            header.*field = value;
            auto chunks = picture(plain, 1);
            chunks[0] = reference::png_header(header);
            expect_read_or_refused(chunks);
        }
    }
}

TEST(PngFields, ChunksMayBeWrongMissingAndTwice) {
    for (const PngHeader& header : {PngHeader{5, 3, 8, 2, 0, 0, 0}, PngHeader{5, 3, 4, 3, 0, 0, 1}}) {
        const auto plain = picture(header, 0);
        ASSERT_TRUE(read(plain));
        for (std::size_t k = 0; k < plain.size(); ++k) {
            SCOPED_TRACE(plain[k].type);
            const auto at = static_cast<std::ptrdiff_t>(k);
            auto chunks = plain;
            chunks[k].sum_error = 1;
            expect_read_or_refused(chunks);
            EXPECT_TRUE(plain[k].type == "IEND" || !read(chunks));
            chunks = plain;
            chunks.erase(chunks.begin() + at);
            expect_read_or_refused(chunks);
            chunks = plain;
            chunks.insert(chunks.begin() + at, plain[k]);
            expect_read_or_refused(chunks);
            for (std::size_t size = 0; size < plain[k].data.size(); ++size) {
                chunks = plain;
                chunks[k].data.resize(size);
                expect_read_or_refused(chunks);
            }
            for (const char* type : {"gAMA", "sBIT", "tRNS", "PLTE", "IHDR", "IEND", "IDAT", "cRIT", "CRIT", "acTL"}) {
                for (const std::size_t size : {0u, 1u, 2u, 3u, 4u, 6u, 16u, 48u, 300u}) {
                    chunks = plain;
                    chunks.insert(chunks.begin() + at, {type, std::string(size, '\x01')});
                    expect_read_or_refused(chunks);
                }
            }
        }
    }
}

}  // namespace tex
