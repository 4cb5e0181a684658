// SPDX-License-Identifier: Apache-2.0
// rdo_rate.h: estimates of the bits that zstd needs for literals and matches.

#pragma once

#include <array>
#include <cstdint>

namespace tex::inline v1 {

// How often each byte is a literal.
using ByteCounts = std::array<std::int64_t, 256>;

// The bits of each byte as a literal: -log2 of its frequency, at least 1.
std::array<float, 256> literal_bits(const ByteCounts& counts);

// The bits of a literal byte whose value is not known yet.
inline constexpr float kUsualLiteral = 7.0f;

// The bits of a match at a new distance, in bytes.
float match_bits(int distance);

// The distances of the last matches, as zstd keeps them.
class RdoMatches {
public:
    // The bits of a match that copies a whole half, or the end of one.
    [[nodiscard]] float bits(int distance, bool whole) const;
    // A half ends with a match at this distance, or with literals: 0.
    void use(int distance);
    [[nodiscard]] const std::array<int, 3>& last() const { return last_; }

private:
    std::array<int, 3> last_ = {1, 4, 8};
    int open_ = 0;  // the distance of the match that ends where the next half begins
};

}  // namespace tex::inline v1
