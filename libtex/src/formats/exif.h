// SPDX-License-Identifier: Apache-2.0
// exif.h: EXIF data in pictures (CIPA DC-008). Reader programs include it, so it needs nothing of libtex.

#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tex::inline v1 {

// What precedes EXIF data in JPEG.
inline constexpr std::string_view kExifMark("Exif\0\0", 6);

// The orientation in the first directory of EXIF data, which are a TIFF file without a picture; 1 if there is none, or
// if the data are damaged. Values above 8 have no meaning.
inline std::uint32_t exif_orientation(std::string_view exif) {
    const bool big_endian = exif.starts_with("MM");
    const auto number = [&](std::size_t at, std::size_t count) {
        std::uint64_t value = 0;
        if (at > exif.size() || count > exif.size() - at) return value;
        for (std::size_t k = 0; k < count; ++k)
            value = value << 8 | static_cast<unsigned char>(exif[big_endian ? at + k : at + count - 1 - k]);
        return value;
    };
    constexpr std::uint64_t kTag = 0x0112, kShort = 3;
    const std::size_t directory = number(4, 4);
    for (std::size_t k = 0; k < number(directory, 2); ++k) {
        const std::size_t entry = directory + 2 + 12 * k;
        if (number(entry, 2) == kTag && number(entry + 2, 2) == kShort)
            return static_cast<std::uint32_t>(number(entry + 8, 2));
    }
    return 1;
}

}  // namespace tex::inline v1
