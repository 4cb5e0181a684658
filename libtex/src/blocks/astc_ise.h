// SPDX-License-Identifier: Apache-2.0
// astc_ise.h: integer sequences of ASTC: values of a range whose size is 2^n, 3 2^n or 5 2^n. The upper parts of five
// values of 3 2^n (trits) share 8 bits, those of three values of 5 2^n (quints) share 7 bits. (Khronos Data Format
// Specification 1.3, "Integer Sequence Encoding", "Endpoint Unquantization", "Weight Unquantization".)

#pragma once

#include <cstddef>
#include <cstdint>

namespace tex::inline v1 {

// The 128 bits of a block, from the lowest one.
struct AstcBits {
    std::uint64_t low = 0, high = 0;

    // `count` bits, at most 32, from bit `at` on; 0 beyond the end.
    [[nodiscard]] unsigned at(int at, int count) const {
        if (at >= 128) return 0;
        std::uint64_t bits = at >= 64 ? high >> (at - 64) : low >> at;
        if (at > 0 && at < 64) bits |= high << (64 - at);
        return static_cast<unsigned>(bits & ((std::uint64_t{1} << count) - 1));
    }

    // Adds bits that are 0 so far, at most 64.
    void put(int at, int count, std::uint64_t bits) {
        if (at >= 64) {
            high |= bits << (at - 64);
        } else {
            low |= bits << at;
            if (at + count > 64) high |= bits >> (64 - at);
        }
    }

    // These bits from the other end.
    [[nodiscard]] AstcBits reversed() const;
};

[[nodiscard]] AstcBits read_astc_bits(const std::byte* block);
void write_astc_bits(const AstcBits& bits, std::byte* block);

// The ranges of values, from the smallest to the greatest. A value is stored as upper 2^bits + lower, where `upper` is
// a trit or a quint.
struct AstcRange {
    int levels;
    int bits;
    int upper;  // 3: trits, 5: quints, 1: neither
};
inline constexpr int kAstcRanges = 21;
inline constexpr AstcRange kAstcRangeTable[kAstcRanges] = {
    {2, 1, 1},  {3, 0, 3},  {4, 2, 1},  {5, 0, 5},   {6, 1, 3},   {8, 3, 1},   {10, 1, 5},
    {12, 2, 3}, {16, 4, 1}, {20, 2, 5}, {24, 3, 3},  {32, 5, 1},  {40, 3, 5},  {48, 4, 3},
    {64, 6, 1}, {80, 4, 5}, {96, 5, 3}, {128, 7, 1}, {160, 5, 5}, {192, 6, 3}, {256, 8, 1},
};
inline constexpr int kAstcWeightRanges = 12;    // those of weights are the first ones
inline constexpr int kAstcLeastColorRange = 4;  // colours have 6 levels or more

// The bits of `count` values of a range.
constexpr int astc_ise_bits(int range, int count) {
    const AstcRange r = kAstcRangeTable[range];
    const int shared = r.upper == 3 ? (8 * count + 4) / 5 : r.upper == 5 ? (7 * count + 2) / 3 : 0;
    return count * r.bits + shared;
}

// The greatest range of which `count` values have at most so many bits, or -1.
[[nodiscard]] int astc_range_within(int count, int bits);

// Reads `count` values from bit `at` on; returns them as stored.
void read_astc_ise(const AstcBits& bits, int at, int range, int count, std::uint8_t* values);

// Adds `count` values, from bit `at` on.
void write_astc_ise(AstcBits& bits, int at, int range, int count, const std::uint8_t* values);

// What stored values mean: colours from 0 to 255, weights from 0 to 64. Values that the range does not have are 0.
struct AstcMeanings {
    std::uint8_t color[kAstcRanges][256] = {};
    std::uint8_t weight[kAstcWeightRanges][32] = {};
};
extern const AstcMeanings kAstcMeanings;

}  // namespace tex::inline v1
