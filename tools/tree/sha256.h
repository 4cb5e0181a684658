// SPDX-License-Identifier: Apache-2.0
// sha256.h: SHA-256 (FIPS 180-4), the name of contents. Its own hundred lines, because the libraries that have it
// (OpenSSL, nettle) would be loaded by every start of a command that needs nothing else of them.

#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace tex::cli {

struct Digest {
    std::array<std::uint8_t, 32> bytes = {};

    friend auto operator<=>(const Digest&, const Digest&) = default;
    // 64 hexadecimal digits.
    [[nodiscard]] std::string hex() const;
    [[nodiscard]] static std::optional<Digest> from_hex(std::string_view text);
};

class Sha256 {
public:
    Sha256& add(const void* data, std::size_t size);
    Sha256& add(std::string_view text) { return add(text.data(), text.size()); }
    // To be called once.
    [[nodiscard]] Digest finish();

private:
    void block(const std::uint8_t* data);

    std::array<std::uint32_t, 8> state_ = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                           0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
    std::array<std::uint8_t, 64> open_ = {};  // bytes that do not fill a block yet
    std::uint64_t size_ = 0;
};

[[nodiscard]] inline Digest digest_of(std::string_view text) { return Sha256().add(text).finish(); }

}  // namespace tex::cli
