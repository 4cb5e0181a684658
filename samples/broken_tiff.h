// SPDX-License-Identifier: Apache-2.0
// broken_tiff.h: a TIFF for samples/broken, whose tag asks its readers to turn it.

#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "reference/damage.h"

namespace tex {

// An RGB TIFF without compression, whose orientation is 6: the top row is the right side of the picture.
inline std::vector<std::byte> turned_tiff(const reference::Codes& codes) {
    const auto width = static_cast<std::uint32_t>(codes.extent.width),
               height = static_cast<std::uint32_t>(codes.extent.height);
    constexpr std::uint32_t kShort = 3, kLong = 4, kEntries = 9, kDirectory = 8;
    constexpr std::uint32_t kBits = kDirectory + 2 + 12 * kEntries + 4, kTexels = kBits + 6;
    const std::uint32_t entries[kEntries][4] = {{256, kLong, 1, width},   {257, kLong, 1, height},
                                                {258, kShort, 3, kBits},  // BitsPerSample
                                                {262, kShort, 1, 2},      // PhotometricInterpretation: RGB
                                                {273, kLong, 1, kTexels}, {274, kShort, 1, 6},  // Orientation
                                                {277, kShort, 1, 3},                            // SamplesPerPixel
                                                {278, kLong, 1, height},  {279, kLong, 1, 3 * width * height}};
    std::vector<std::byte> bytes;
    const auto put = [&](std::uint32_t value, int count) {
        for (int k = 0; k < count; ++k) bytes.push_back(static_cast<std::byte>(value >> (8 * k) & 0xff));
    };
    put(0x2a4949, 4);
    put(kDirectory, 4);
    put(kEntries, 2);
    for (const auto& [tag, type, count, value] : entries) {
        put(tag, 2);
        put(type, 2);
        put(count, 4);
        put(value, 4);
    }
    put(0, 4);
    for (int k = 0; k < 3; ++k) put(8, 2);
    for (const unsigned char code : codes.values) bytes.push_back(static_cast<std::byte>(code));
    return bytes;
}

}  // namespace tex
