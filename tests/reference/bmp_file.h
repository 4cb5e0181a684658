// SPDX-License-Identifier: Apache-2.0
// bmp_file.h: writes BMP files of every kind, for tests of readers.

#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "reference/tga_file.h"

namespace tex::reference {

struct BmpFile {
    int width = 5, height = 4;
    int depth = 24;
    StoredTexel texel;
    std::uint32_t header = 40;
    std::uint32_t compression = 0;  // 0 none, 1 RLE8, 2 RLE4, 3 masks, 6 masks with alpha
    bool from_top = false;
    std::vector<std::uint32_t> masks;  // three or four
    std::vector<std::uint32_t> palette;
    std::uint32_t colors = 0;  // the number that the header states
    std::uint32_t gap = 0;     // bytes before the texels

    [[nodiscard]] FileBytes make() const {
        FileBytes bytes;
        put_number(bytes, 'B' | 'M' << 8, 2);
        bytes.resize(14);
        put_header(bytes);
        for (const std::uint32_t color : palette) put_number(bytes, color, header == 12 ? 3 : 4);
        bytes.resize(bytes.size() + gap, std::byte{0xee});
        for (std::size_t k = 0; k < 4; ++k) bytes[10 + k] = static_cast<std::byte>(bytes.size() >> (8 * k));
        compression == 1 || compression == 2 ? put_rle(bytes) : put_rows(bytes);
        for (std::size_t k = 0; k < 4; ++k) bytes[2 + k] = static_cast<std::byte>(bytes.size() >> (8 * k));
        return bytes;
    }

private:
    void put_header(FileBytes& bytes) const {
        put_number(bytes, header, 4);
        const int field = header == 12 ? 2 : 4;
        put_number(bytes, static_cast<std::uint32_t>(width), field);
        put_number(bytes, static_cast<std::uint32_t>(from_top ? -height : height), field);
        put_number(bytes, 1, 2);
        put_number(bytes, static_cast<std::uint32_t>(depth), 2);
        if (header == 12) return;
        put_number(bytes, compression, 4);
        bytes.resize(bytes.size() + 12);
        put_number(bytes, colors, 4);
        put_number(bytes, 0, 4);
        for (const std::uint32_t mask : masks) put_number(bytes, mask, 4);
        if (header > 40) bytes.resize(14 + header);
    }
    [[nodiscard]] int row_of(int k) const { return from_top ? k : height - 1 - k; }
    void put_rows(FileBytes& bytes) const {
        for (int k = 0; k < height; ++k) {
            std::vector<std::uint32_t> row(static_cast<std::size_t>((width * depth + 31) / 32 * 4));
            for (int i = 0; i < width; ++i) {
                const std::uint32_t value = texel(i, row_of(k));
                for (int b = 0; b < std::max(depth / 8, 1); ++b) {
                    const auto at = static_cast<std::size_t>(i * depth / 8 + b);
                    row[at] |= depth < 8 ? value << std::max(8 - depth - i * depth % 8, 0) : value >> (8 * b) & 0xff;
                }
            }
            for (const std::uint32_t byte : row) put_number(bytes, byte, 1);
        }
    }
    // Runs where colours repeat, otherwise absolute codes of three and more.
    void put_rle(FileBytes& bytes) const {
        for (int k = 0; k < height; ++k) {
            for (int i = 0; i < width;) {
                int run = 1;
                while (i + run < width && run < 255 && texel(i + run, row_of(k)) == texel(i, row_of(k))) ++run;
                const int left = std::min(width - i, 255);
                if (run == 1 && left >= 3) {
                    put_absolute(bytes, i, row_of(k), left);
                    run = left;
                } else {
                    put_number(bytes, static_cast<std::uint32_t>(run), 1);
                    put_number(bytes, texel(i, row_of(k)) * (compression == 2 ? 17 : 1), 1);
                }
                i += run;
            }
            put_number(bytes, k + 1 < height ? 0 : 0x100, 2);
        }
    }
    void put_absolute(FileBytes& bytes, int i, int j, int count) const {
        put_number(bytes, 0, 1);
        put_number(bytes, static_cast<std::uint32_t>(count), 1);
        const std::size_t begin = bytes.size();
        for (int k = 0; k < count; ++k) {
            if (compression == 1 || k % 2 == 0)
                put_number(bytes, texel(i + k, j) << (compression == 1 ? 0 : 4), 1);
            else
                bytes.back() |= static_cast<std::byte>(texel(i + k, j));
        }
        if ((bytes.size() - begin) % 2 != 0) put_number(bytes, 0, 1);
    }
};

}  // namespace tex::reference
