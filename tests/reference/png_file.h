// SPDX-License-Identifier: Apache-2.0
// png_file.h: PNG files written without libpng and zlib, so that every chunk and field can have any value.
//
// Source: the PNG specification (W3C, third edition), RFC 1950 and RFC 1951. Texels are stored, not compressed.

#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace tex::reference {

inline std::string big_endian(std::uint32_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xff);
    return bytes;
}

// The checksum (CRC) of a chunk's type and data.
inline std::uint32_t png_sum(std::string_view bytes) {
    std::uint32_t sum = 0xffffffff;
    for (const char c : bytes) {
        sum ^= static_cast<unsigned char>(c);
        for (int bit = 0; bit < 8; ++bit) sum = sum >> 1 ^ ((sum & 1) != 0 ? 0xedb88320 : 0);
    }
    return ~sum;
}

inline std::uint32_t adler32(std::string_view bytes) {
    std::uint32_t a = 1, b = 0;
    for (const char c : bytes) {
        a = (a + static_cast<unsigned char>(c)) % 65521;
        b = (b + a) % 65521;
    }
    return b << 16 | a;
}

// A zlib stream of stored blocks.
inline std::string stored(std::string_view bytes) {
    std::string stream("\x78\x01", 2);
    const std::uint32_t sum = adler32(bytes);
    do {
        const std::size_t size = std::min<std::size_t>(bytes.size(), 0xffff);
        stream += static_cast<char>(size == bytes.size() ? 1 : 0);
        for (const std::size_t field : {size, size ^ 0xffff}) {
            stream += static_cast<char>(field & 0xff);
            stream += static_cast<char>(field >> 8 & 0xff);
        }
        stream += bytes.substr(0, size);
        bytes.remove_prefix(size);
    } while (!bytes.empty());
    return stream + big_endian(sum);
}

struct PngChunk {
    std::string type, data;
    std::uint32_t sum_error = 0;  // the error of its checksum
};

inline std::string write_png(const std::vector<PngChunk>& chunks) {
    std::string bytes("\x89PNG\r\n\x1a\n", 8);
    for (const PngChunk& chunk : chunks) {
        bytes += big_endian(static_cast<std::uint32_t>(chunk.data.size()));
        bytes.append(chunk.type).append(chunk.data);
        bytes += big_endian(png_sum(chunk.type + chunk.data) ^ chunk.sum_error);
    }
    return bytes;
}

struct PngHeader {
    std::uint32_t width = 1, height = 1;
    unsigned bits = 8, color_type = 0, compression = 0, filter = 0, interlace = 0;
};

inline PngChunk png_header(const PngHeader& header) {
    std::string data = big_endian(header.width) + big_endian(header.height);
    for (const unsigned field : {header.bits, header.color_type, header.compression, header.filter, header.interlace})
        data += static_cast<char>(field);
    return {"IHDR", data};
}

// The number of samples of a texel, by colour type: grey, -, RGB, palette, grey and alpha, -, RGB and alpha.
inline unsigned png_samples(unsigned color_type) {
    constexpr unsigned kSamples[] = {1, 1, 3, 1, 2, 1, 4, 1};
    return kSamples[color_type % 8];
}

// One filtered row, after the byte that names the filter. `before` is the row above; it is all 0 for the first row of a
// pass.
inline std::string png_filtered(const std::string& row, const std::string& before, std::size_t texel, unsigned filter) {
    std::string bytes(1, static_cast<char>(filter));
    const auto byte = [](const std::string& of, std::size_t at) {
        return static_cast<int>(static_cast<unsigned char>(of[at]));
    };
    for (std::size_t k = 0; k < row.size(); ++k) {
        const int left = k >= texel ? byte(row, k - texel) : 0;
        const int above = byte(before, k);
        const int corner = k >= texel ? byte(before, k - texel) : 0;
        const int guess = left + above - corner;
        const int to_left = std::abs(guess - left), to_above = std::abs(guess - above),
                  to_corner = std::abs(guess - corner);
        const int paeth = to_left <= to_above && to_left <= to_corner ? left : to_above <= to_corner ? above : corner;
        const int predictions[] = {0, left, above, (left + above) / 2, paeth};
        bytes += static_cast<char>(byte(row, k) - predictions[filter % 5]);
    }
    return bytes;
}

// The texels of a picture in the form that IDAT has before compression: sample(x, y, c) with the header's bit depth.
// The rows use filters 0 to 4 in turn, starting with `filter`.
inline std::string png_texels(const PngHeader& header, unsigned filter,
                              const std::function<unsigned(unsigned x, unsigned y, unsigned c)>& sample) {
    struct Pass {
        unsigned x, y, step_x, step_y;
    };
    constexpr Pass kWhole[] = {{0, 0, 1, 1}};
    constexpr Pass kAdam7[] = {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4},
                               {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}};
    const unsigned samples = png_samples(header.color_type);
    std::string bytes;
    const auto add_pass = [&](const Pass& pass) {
        if (pass.x >= header.width || pass.y >= header.height) return;
        const std::size_t texels = (header.width - pass.x + pass.step_x - 1) / pass.step_x;
        std::string before((texels * samples * header.bits + 7) / 8, '\0');
        for (unsigned y = pass.y; y < header.height; y += pass.step_y) {
            std::string row(before.size(), '\0');
            std::size_t at = 0;  // in bits
            for (unsigned x = pass.x; x < header.width; x += pass.step_x) {
                for (unsigned c = 0; c < samples; ++c) {
                    for (unsigned bit = header.bits; bit-- > 0; ++at) {
                        if ((sample(x, y, c) >> bit & 1) != 0)
                            row[at / 8] = static_cast<char>(row[at / 8] | 0x80 >> at % 8);
                    }
                }
            }
            bytes += png_filtered(row, before, std::max(1u, samples * header.bits / 8), filter++ % 5);
            before = row;
        }
    };
    if (header.interlace == 1) {
        for (const Pass& pass : kAdam7) add_pass(pass);
    } else {
        add_pass(kWhole[0]);
    }
    return bytes;
}

}  // namespace tex::reference
