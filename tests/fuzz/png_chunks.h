// SPDX-License-Identifier: Apache-2.0
// png_chunks.h: PNG files as lists of chunks, so that a fuzzer changes what is in them and lengths and sums stay true.

#pragma once

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

using PngBytes = std::vector<std::uint8_t>;

struct PngChunk {
    std::array<std::uint8_t, 4> type;
    PngBytes data;

    [[nodiscard]] bool is(const char (&name)[5]) const { return std::memcmp(type.data(), name, type.size()) == 0; }
};

struct PngHeader {
    std::uint32_t width = 1, height = 1;
    std::uint8_t bit_depth = 8, color_type = 0, interlace = 0;
};

constexpr std::size_t kPngSignature = 8;

inline std::uint32_t big_endian(const std::uint8_t* bytes) {
    return std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 | std::uint32_t{bytes[2]} << 8 | bytes[3];
}

inline void append_big_endian(PngBytes& bytes, std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

// The chunks of any bytes; one that is longer than what is left ends there. Sums are not looked at.
inline std::vector<PngChunk> png_chunks(const std::uint8_t* data, std::size_t size) {
    std::vector<PngChunk> chunks;
    for (std::size_t at = kPngSignature; at + 8 <= size;) {
        const std::size_t length = std::min<std::size_t>(big_endian(data + at), size - at - 8);
        PngChunk chunk;
        std::copy_n(data + at + 4, chunk.type.size(), chunk.type.begin());
        chunk.data.assign(data + at + 8, data + at + 8 + length);
        chunks.push_back(chunk);
        at += 8 + length + 4;
    }
    return chunks;
}

inline PngBytes png_file(const std::vector<PngChunk>& chunks) {
    PngBytes bytes = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    for (const PngChunk& chunk : chunks) {
        append_big_endian(bytes, static_cast<std::uint32_t>(chunk.data.size()));
        const std::size_t summed = bytes.size();
        bytes.insert(bytes.end(), chunk.type.begin(), chunk.type.end());
        bytes.insert(bytes.end(), chunk.data.begin(), chunk.data.end());
        append_big_endian(bytes, static_cast<std::uint32_t>(
                                     crc32(0, bytes.data() + summed, static_cast<uInt>(bytes.size() - summed))));
    }
    return bytes;
}

inline PngHeader png_header(const PngBytes& ihdr) {
    if (ihdr.size() < 13) return {};
    return {big_endian(ihdr.data()), big_endian(ihdr.data() + 4), ihdr[8], ihdr[9], ihdr[12]};
}

inline PngChunk png_chunk(const PngHeader& header) {
    PngChunk chunk{{'I', 'H', 'D', 'R'}, {}};
    append_big_endian(chunk.data, header.width);
    append_big_endian(chunk.data, header.height);
    chunk.data.insert(chunk.data.end(), {header.bit_depth, header.color_type, 0, 0, header.interlace});
    return chunk;
}

// Where the rows that IDAT holds begin, each with the number of its filter, and after them where the last one ends. Not
// beyond `most` bytes.
inline std::vector<std::size_t> png_rows(const PngHeader& header, std::size_t most) {
    constexpr std::uint32_t kPasses[7][4] = {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4},
                                             {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}};  // x, y, steps
    constexpr std::uint32_t kWhole[1][4] = {{0, 0, 1, 1}};
    constexpr std::size_t kChannels[8] = {1, 1, 3, 1, 2, 1, 4, 1};
    const std::size_t bits = header.bit_depth * kChannels[header.color_type % 8];
    std::vector<std::size_t> begins = {0};
    for (int pass = 0; pass < (header.interlace == 1 ? 7 : 1); ++pass) {
        const auto& [x, y, step_x, step_y] = header.interlace == 1 ? kPasses[pass] : kWhole[pass];
        if (header.width <= x || header.height <= y) continue;
        const std::size_t width = (std::size_t{header.width} - x + step_x - 1) / step_x;
        const std::size_t row = 1 + (width * bits + 7) / 8;
        for (std::uint32_t j = y; j < header.height && begins.back() + row <= most; j += step_y)
            begins.push_back(begins.back() + row);
    }
    return begins;
}

// Inflates as many bytes as zlib makes of `packed`, however it ends; not more than `most`.
inline PngBytes inflated(const PngBytes& packed, std::size_t most) {
    PngBytes bytes(most);
    z_stream stream{};
    if (inflateInit(&stream) != Z_OK) return {};
    stream.next_in = const_cast<std::uint8_t*>(packed.data());
    stream.avail_in = static_cast<uInt>(packed.size());
    stream.next_out = bytes.data();
    stream.avail_out = static_cast<uInt>(bytes.size());
    inflate(&stream, Z_FINISH);
    bytes.resize(stream.total_out);
    inflateEnd(&stream);
    return bytes;
}

inline PngBytes deflated(const PngBytes& bytes, int level) {
    uLongf size = compressBound(static_cast<uLong>(bytes.size()));
    PngBytes packed(size);
    if (compress2(packed.data(), &size, bytes.data(), static_cast<uLong>(bytes.size()), level) != Z_OK) return {};
    packed.resize(size);
    return packed;
}
