// SPDX-License-Identifier: Apache-2.0
// bytes.h: numbers in the headers of files, little-endian unless they say otherwise.

#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace tex::inline v1 {

inline std::uint32_t load_u32(const std::byte* p) {
    return std::to_integer<std::uint32_t>(p[0]) | std::to_integer<std::uint32_t>(p[1]) << 8 |
           std::to_integer<std::uint32_t>(p[2]) << 16 | std::to_integer<std::uint32_t>(p[3]) << 24;
}

inline std::uint32_t load_big_u32(const std::byte* p) {
    return std::to_integer<std::uint32_t>(p[3]) | std::to_integer<std::uint32_t>(p[2]) << 8 |
           std::to_integer<std::uint32_t>(p[1]) << 16 | std::to_integer<std::uint32_t>(p[0]) << 24;
}

inline std::uint64_t load_u64(const std::byte* p) {
    return load_u32(p) | static_cast<std::uint64_t>(load_u32(p + 4)) << 32;
}

// Builds the header of a file.
class ByteWriter {
public:
    void u8(std::uint32_t value) { bytes_.push_back(static_cast<std::byte>(value & 0xff)); }
    void u32(std::uint32_t value) {
        for (int shift = 0; shift < 32; shift += 8) u8(value >> shift);
    }
    void u64(std::uint64_t value) {
        u32(static_cast<std::uint32_t>(value & 0xffffffff));
        u32(static_cast<std::uint32_t>(value >> 32));
    }
    void text(std::string_view characters) {
        for (const char c : characters) u8(static_cast<unsigned char>(c));
    }
    void zeros(std::size_t count) { bytes_.resize(bytes_.size() + count); }
    void align(std::size_t alignment) { zeros((alignment - bytes_.size() % alignment) % alignment); }

    [[nodiscard]] std::size_t size() const { return bytes_.size(); }
    [[nodiscard]] std::vector<std::byte> take() { return std::move(bytes_); }

private:
    std::vector<std::byte> bytes_;
};

}  // namespace tex::inline v1
