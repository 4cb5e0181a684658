// SPDX-License-Identifier: Apache-2.0

#include "formats/png/png_chunk.h"

#include <libdeflate.h>

namespace tex::inline v1 {

void put_png_number(std::vector<std::byte>& to, std::uint32_t value, int bytes) {
    for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) to.push_back(static_cast<std::byte>(value >> shift));
}

std::size_t begin_png_chunk(std::vector<std::byte>& to, std::string_view type) {
    put_png_number(to, 0, 4);
    for (const char c : type) to.push_back(static_cast<std::byte>(c));
    return to.size();
}

void end_png_chunk(std::vector<std::byte>& to, std::size_t begun) {
    constexpr std::size_t kType = 4;
    const auto length = static_cast<std::uint32_t>(to.size() - begun);
    for (std::size_t k = 0; k < 4; ++k) to[begun - 8 + k] = static_cast<std::byte>(length >> (24 - 8 * k));
    const std::uint32_t crc = libdeflate_crc32(0, to.data() + begun - kType, kType + length);
    put_png_number(to, crc, 4);
}

}  // namespace tex::inline v1
