// SPDX-License-Identifier: Apache-2.0
// exr_file.h: EXR files as lists of attributes and chunks, written without OpenEXR, so that every field can have any
// value.
//
// Source: "OpenEXR File Layout" of the OpenEXR project. Chunks are written uncompressed.

#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tex::reference {

// Appends a little-endian field of `count` bytes.
inline void put_little(std::string& bytes, std::uint64_t value, int count) {
    for (int k = 0; k < count; ++k) bytes += static_cast<char>(value >> (8 * k) & 0xff);
}
inline std::uint64_t little_at(std::string_view bytes, std::size_t at, int count) {
    std::uint64_t value = 0;
    for (int k = count; k-- > 0;)
        value = value << 8 | static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(k)]);
    return value;
}
inline std::string little(std::initializer_list<std::uint64_t> values, int count) {
    std::string bytes;
    for (const std::uint64_t value : values) put_little(bytes, value, count);
    return bytes;
}

struct ExrAttribute {
    std::string name, type, value;
    std::optional<std::uint32_t> size = {};  // the size in the file, if it is not the size of the value
};

struct ExrFile {
    static constexpr std::uint32_t kTiled = 0x200, kLongNames = 0x400, kDeep = 0x800, kMultipart = 0x1000;

    std::uint32_t magic = 20000630, version = 2;
    std::vector<std::vector<ExrAttribute>> parts;  // the headers
    std::vector<std::uint64_t> table;              // the offsets of chunks from the beginning of `chunks`
    std::string chunks;

    [[nodiscard]] ExrAttribute* find(std::string_view name, std::size_t part = 0) {
        for (ExrAttribute& attribute : parts.at(part)) {
            if (attribute.name == name) return &attribute;
        }
        return nullptr;
    }
};

inline std::string write_exr(const ExrFile& file) {
    std::string bytes = little({file.magic, file.version}, 4);
    for (const std::vector<ExrAttribute>& header : file.parts) {
        for (const ExrAttribute& attribute : header) {
            bytes.append(attribute.name).push_back('\0');
            bytes.append(attribute.type).push_back('\0');
            put_little(bytes, attribute.size.value_or(static_cast<std::uint32_t>(attribute.value.size())), 4);
            bytes += attribute.value;
        }
        bytes += '\0';
    }
    if ((file.version & ExrFile::kMultipart) != 0) bytes += '\0';
    const std::uint64_t chunks = bytes.size() + 8 * file.table.size();
    for (const std::uint64_t offset : file.table) put_little(bytes, chunks + offset, 8);
    return bytes + file.chunks;
}

// The file for which write_exr() gives these bytes, or nothing if the headers do not end within them. The bytes between
// the headers and the first chunk in the table are the table.
inline std::optional<ExrFile> parse_exr(std::string_view bytes) {
    if (bytes.size() < 8) return std::nullopt;
    ExrFile file;
    file.magic = static_cast<std::uint32_t>(little_at(bytes, 0, 4));
    file.version = static_cast<std::uint32_t>(little_at(bytes, 4, 4));
    std::size_t at = 8;
    const auto text = [&]() -> std::optional<std::string> {
        const std::size_t end = bytes.find('\0', at);
        if (end == std::string_view::npos) return std::nullopt;
        std::string word(bytes.substr(at, end - at));
        at = end + 1;
        return word;
    };
    const bool is_multipart = (file.version & ExrFile::kMultipart) != 0;
    do {
        file.parts.emplace_back();
        for (;;) {
            const auto name = text();
            if (!name) return std::nullopt;
            if (name->empty()) break;
            const auto type = text();
            if (!type || bytes.size() - at < 4) return std::nullopt;
            const std::uint64_t size = little_at(bytes, at, 4);
            at += 4;
            if (bytes.size() - at < size) return std::nullopt;
            file.parts.back().push_back({*name, *type, std::string(bytes.substr(at, size))});
            at += size;
        }
    } while (is_multipart && !file.parts.back().empty());
    if (is_multipart) file.parts.pop_back();

    std::uint64_t first = bytes.size();
    std::vector<std::uint64_t> offsets;
    for (; at + 8 <= first; at += 8) {
        offsets.push_back(little_at(bytes, at, 8));
        if (offsets.back() > at) first = std::min(first, offsets.back());
    }
    for (const std::uint64_t offset : offsets) file.table.push_back(offset - at);
    file.chunks = bytes.substr(at);
    return file;
}

struct ExrChannel {
    std::string name;
    std::uint32_t type = 1;  // 0 uint, 1 half, 2 float
    std::uint32_t x_sampling = 1, y_sampling = 1;
    std::uint32_t linear = 0;  // one byte, and three reserved ones
};

inline std::string exr_channels(const std::vector<ExrChannel>& channels) {
    std::string value;
    for (const ExrChannel& channel : channels) {
        value.append(channel.name).push_back('\0');
        value += little({channel.type, channel.linear, channel.x_sampling, channel.y_sampling}, 4);
    }
    return value + '\0';
}

// An attribute of the type tiledesc. Mode: levels (0 one, 1 mipmap, 2 ripmap), plus 16 to round up.
inline std::string exr_tiles(std::uint32_t width, std::uint32_t height, char mode) {
    return little({width, height}, 4) + mode;
}

inline std::string exr_box(int x0, int y0, int x1, int y1) {
    const auto bits = [](int value) { return static_cast<std::uint32_t>(value); };
    return little({bits(x0), bits(y0), bits(x1), bits(y1)}, 4);
}

// The attributes that every part must have, for a data window of width x height at (0, 0).
inline std::vector<ExrAttribute> exr_header(int width, int height, const std::vector<ExrChannel>& channels,
                                            char compression = 0) {
    const std::string box = exr_box(0, 0, width - 1, height - 1);
    const std::string one = little({0x3f800000}, 4);
    return {{"channels", "chlist", exr_channels(channels)},
            {"compression", "compression", std::string(1, compression)},
            {"dataWindow", "box2i", box},
            {"displayWindow", "box2i", box},
            {"lineOrder", "lineOrder", std::string(1, '\0')},
            {"pixelAspectRatio", "float", one},
            {"screenWindowCenter", "v2f", little({0, 0}, 4)},
            {"screenWindowWidth", "float", one}};
}

// One part of scan lines, with one row in each chunk. `rows` holds width * height values of each channel in their
// stored form, row by row, and channel by channel within a row.
inline ExrFile exr_scan_lines(int width, int height, const std::vector<ExrChannel>& channels, const std::string& rows) {
    ExrFile file;
    file.parts = {exr_header(width, height, channels)};
    const std::size_t row = rows.size() / static_cast<std::size_t>(height);
    for (int j = 0; j < height; ++j) {
        file.table.push_back(file.chunks.size());
        file.chunks += little({static_cast<std::uint64_t>(j), row}, 4);
        file.chunks += rows.substr(static_cast<std::size_t>(j) * row, row);
    }
    return file;
}

// One part with one tile, which is as large as the picture.
inline ExrFile exr_tile(int width, int height, const std::vector<ExrChannel>& channels, const std::string& rows) {
    ExrFile file;
    file.version |= ExrFile::kTiled;
    file.parts = {exr_header(width, height, channels)};
    file.parts[0].push_back(
        {"tiles", "tiledesc", exr_tiles(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), 0)});
    file.table = {0};
    file.chunks = little({0, 0, 0, 0, rows.size()}, 4) + rows;
    return file;
}

}  // namespace tex::reference
