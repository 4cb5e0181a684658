// SPDX-License-Identifier: Apache-2.0
// tiff_maker.h: TIFF files for tests of the reader.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <vector>

#include <tex/file.h>

#include "formats/reader/reader.h"
#include "formats/reader/reader_rows.h"

namespace tex {

using Bytes = std::vector<std::byte>;

inline ReadOptions quick() {
    ReadOptions options;
    options.reader_timeout = 20;
    return options;
}

inline void put(Bytes& bytes, std::uint32_t value, int count) {
    for (int k = 0; k < count; ++k) bytes.push_back(static_cast<std::byte>(value >> (8 * k)));
}

// An uncompressed TIFF with one strip, built tag by tag.
struct TiffMaker {
    int width, height;
    int samples = 1;
    int bits = 8;
    int sample_format = 1;  // 1 unsigned, 2 signed, 3 floating
    int photometric = 1;    // 1 black is zero, 2 RGB, 3 palette, 5 CMYK
    int extra = -1;         // type of an extra sample: 1 associated, 2 unassociated alpha
    int orientation = 1;
    Bytes palette = {};  // 3 * 2^bits shorts
    Bytes data = {};

    [[nodiscard]] Bytes make() const {
        std::vector<std::array<std::uint32_t, 4>> tags = {
            {256, 4, 1, static_cast<std::uint32_t>(width)},       {257, 4, 1, static_cast<std::uint32_t>(height)},
            {258, 3, static_cast<std::uint32_t>(samples), 0},     {259, 3, 1, 1},
            {262, 3, 1, static_cast<std::uint32_t>(photometric)}, {273, 4, 1, 0},
            {274, 3, 1, static_cast<std::uint32_t>(orientation)}, {277, 3, 1, static_cast<std::uint32_t>(samples)},
            {278, 4, 1, static_cast<std::uint32_t>(height)},      {279, 4, 1, static_cast<std::uint32_t>(data.size())}};
        if (!palette.empty()) tags.push_back({320, 3, static_cast<std::uint32_t>(palette.size() / 2), 0});
        if (extra >= 0) tags.push_back({338, 3, 1, static_cast<std::uint32_t>(extra)});
        tags.push_back({339, 3, static_cast<std::uint32_t>(samples), 0});
        const auto after = static_cast<std::uint32_t>(8 + 2 + 12 * tags.size() + 4);
        Bytes tail;
        for (auto& tag : tags) {
            const bool list = tag[0] == 258 || tag[0] == 339;
            if (list && samples > 2) {
                tag[3] = after + static_cast<std::uint32_t>(tail.size());
                for (int k = 0; k < samples; ++k)
                    put(tail, static_cast<std::uint32_t>(tag[0] == 258 ? bits : sample_format), 2);
            } else if (list) {
                const auto v = static_cast<std::uint32_t>(tag[0] == 258 ? bits : sample_format);
                tag[3] = samples == 2 ? v | v << 16 : v;
            } else if (tag[0] == 320) {
                tag[3] = after + static_cast<std::uint32_t>(tail.size());
                tail.insert(tail.end(), palette.begin(), palette.end());
            } else if (tag[0] == 273) {
                continue;  // filled in when the tail is known
            }
        }
        Bytes bytes;
        put(bytes, 0x002a4949, 4);
        put(bytes, 8, 4);
        put(bytes, static_cast<std::uint32_t>(tags.size()), 2);
        for (const auto& tag : tags) {
            put(bytes, tag[0], 2);
            put(bytes, tag[1], 2);
            put(bytes, tag[2], 4);
            put(bytes, tag[0] == 273 ? after + static_cast<std::uint32_t>(tail.size()) : tag[3], 4);
        }
        put(bytes, 0, 4);
        bytes.insert(bytes.end(), tail.begin(), tail.end());
        bytes.insert(bytes.end(), data.begin(), data.end());
        return bytes;
    }
};

template <class T>
Bytes raw(std::initializer_list<T> values) {
    Bytes bytes(values.size() * sizeof(T));
    std::memcpy(bytes.data(), values.begin(), bytes.size());
    return bytes;
}

inline Result<Image> read(const Bytes& bytes, const ReadOptions& options = quick()) {
    Result<InputFile> file = InputFile::from_memory("test", bytes);
    if (!file) return file.error();
    return read_all(open_reader_rows(*file, options));
}

}  // namespace tex
