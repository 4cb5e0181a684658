// SPDX-License-Identifier: Apache-2.0
// tga_file.h: writes TGA files of every kind, for tests of readers.

#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace tex::reference {

using FileBytes = std::vector<std::byte>;

// `count` bytes of a little-endian number.
inline void put_number(FileBytes& bytes, std::uint32_t value, int count) {
    for (int k = 0; k < count; ++k) bytes.push_back(static_cast<std::byte>(value >> (8 * k)));
}

// The stored bits of the texel in column i of row j, counted from the left and from the top.
using StoredTexel = std::function<std::uint32_t(int i, int j)>;

struct TgaFile {
    int width = 5, height = 4;
    int type = 2;  // 1 indices, 2 colours, 3 grey; 9, 10, 11 with RLE
    int depth = 24;
    StoredTexel texel;
    int alpha_bits = 0;
    bool from_top = false, from_right = false;
    bool packets_cross_rows = false;
    std::string id;
    int palette_first = 0, palette_depth = 0;
    std::vector<std::uint32_t> palette;
    int attribute_type = -1;  // of the extension area; -1: no footer, -2: a footer without that area
    std::string_view comment;

    [[nodiscard]] FileBytes make() const {
        FileBytes bytes;
        put_number(bytes, static_cast<std::uint32_t>(id.size()), 1);
        put_number(bytes, palette.empty() ? 0 : 1, 1);
        put_number(bytes, static_cast<std::uint32_t>(type), 1);
        put_number(bytes, static_cast<std::uint32_t>(palette_first), 2);
        put_number(bytes, static_cast<std::uint32_t>(palette.size()), 2);
        put_number(bytes, static_cast<std::uint32_t>(palette_depth), 1);
        put_number(bytes, 0, 4);
        put_number(bytes, static_cast<std::uint32_t>(width), 2);
        put_number(bytes, static_cast<std::uint32_t>(height), 2);
        put_number(bytes, static_cast<std::uint32_t>(depth), 1);
        put_number(bytes, static_cast<std::uint32_t>(alpha_bits | (from_right ? 0x10 : 0) | (from_top ? 0x20 : 0)), 1);
        for (const char c : id) bytes.push_back(static_cast<std::byte>(c));
        for (const std::uint32_t color : palette) put_number(bytes, color, (palette_depth + 7) / 8);
        put_texels(bytes);
        if (attribute_type != -1) put_footer(bytes);
        return bytes;
    }

private:
    void put_texels(FileBytes& bytes) const {
        std::vector<std::uint32_t> packet;
        for (int row = 0; row < height; ++row) {
            for (int column = 0; column < width; ++column) {
                const std::uint32_t value =
                    texel(from_right ? width - 1 - column : column, from_top ? row : height - 1 - row);
                if (type < 8) {
                    put_number(bytes, value, (depth + 7) / 8);
                    continue;
                }
                const bool is_run = packet.size() >= 2 && packet[0] == packet[1];
                const bool fits = packet.size() < 2 || (is_run ? value == packet[0] : value != packet.back());
                if (packet.size() == 128 || !fits) put_packet(bytes, packet);
                packet.push_back(value);
            }
            if (!packets_cross_rows) put_packet(bytes, packet);
        }
        put_packet(bytes, packet);
    }
    void put_packet(FileBytes& bytes, std::vector<std::uint32_t>& packet) const {
        if (packet.empty()) return;
        const bool is_run = packet.size() >= 2 && packet[0] == packet[1];
        put_number(bytes, static_cast<std::uint32_t>(packet.size() - 1) | (is_run ? 0x80u : 0u), 1);
        for (const std::uint32_t value : packet) {
            put_number(bytes, value, (depth + 7) / 8);
            if (is_run) break;
        }
        packet.clear();
    }
    void put_footer(FileBytes& bytes) const {
        const auto place = static_cast<std::uint32_t>(attribute_type >= 0 ? bytes.size() : 0);
        if (attribute_type >= 0) {
            FileBytes area;
            put_number(area, 495, 2);
            area.resize(43);
            for (const char c : comment) area.push_back(static_cast<std::byte>(c));
            area.resize(494);
            put_number(area, static_cast<std::uint32_t>(attribute_type), 1);
            bytes.insert(bytes.end(), area.begin(), area.end());
        }
        put_number(bytes, place, 4);
        put_number(bytes, 0, 4);
        for (const char c : std::string_view("TRUEVISION-XFILE.\0", 18)) bytes.push_back(static_cast<std::byte>(c));
    }
};

}  // namespace tex::reference
