// SPDX-License-Identifier: Apache-2.0
// exif_data.h: EXIF data for tests.

#pragma once

#include <string>

namespace tex {

// A directory with a width and an orientation.
inline std::string exif_data(int orientation, bool big_endian) {
    std::string data = big_endian ? "MM" : "II";
    const auto put = [&](unsigned value, int bytes) {
        for (int k = 0; k < bytes; ++k)
            data += static_cast<char>(value >> 8 * (big_endian ? bytes - 1 - k : k) & 0xffu);
    };
    const auto put_short_entry = [&](unsigned tag, unsigned value) {
        put(tag, 2);
        put(3, 2);  // SHORT
        put(1, 4);
        put(value, 2);
        put(0, 2);
    };
    put(42, 2);
    put(8, 4);  // where the directory is
    put(2, 2);
    put_short_entry(0x0100, 640);
    put_short_entry(0x0112, static_cast<unsigned>(orientation));
    put(0, 4);
    return data;
}

}  // namespace tex
