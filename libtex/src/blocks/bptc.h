// SPDX-License-Identifier: Apache-2.0
// bptc.h: what BC6H and BC7 blocks have in common: 4x4 texels in 16 bytes, divided into one to three subsets by one of
// 64 partitions, each with two endpoints, between which an index for each texel interpolates (Khronos Data Format
// Specification 1.3, chapter BPTC, whose tables these are; Direct3D 11.3 Functional Specification, 19.5.9 and 19.5.10).

#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace tex::inline v1 {

// The bits of a block, from the lowest one.
class BptcBits {
public:
    explicit BptcBits(const std::byte* block) {
        static_assert(std::endian::native == std::endian::little);
        std::memcpy(&low_, block, sizeof low_);
        std::memcpy(&high_, block + sizeof low_, sizeof high_);
    }

    // The next `count` bits, at most 31.
    unsigned take(int count) {
        const auto bits = static_cast<unsigned>(low_ & ((std::uint64_t{1} << count) - 1));
        skip(count);
        return bits;
    }

    // The next 64 bits, which stay.
    [[nodiscard]] std::uint64_t next() const { return low_; }

    // Leaves out `count` bits, at most 63.
    void skip(int count) {
        low_ = low_ >> count | high_ << 1 << (63 - count);
        high_ >>= count;
    }

private:
    std::uint64_t low_ = 0, high_ = 0;
};

// The subset, from 0, to which a texel (row-major) belongs.
[[nodiscard]] unsigned bptc_subset(int subsets, unsigned partition, unsigned texel);

// The texels of a subset of two or three: bit k is texel k.
[[nodiscard]] unsigned bptc_texels(int subsets, unsigned partition, int subset);

// The texels whose indices lack their highest bits, which are 0.
[[nodiscard]] unsigned bptc_anchors(int subsets, unsigned partition);

// Reads the indices of all texels, of 2, 3 or 4 bits, as the weights of the second endpoint, 0 to 64.
void read_bptc_weights(BptcBits& bits, int subsets, unsigned partition, int index_bits, std::uint8_t weights[16]);

// The value between two endpoints. Exact for negative ones, too: the shift rounds down.
constexpr int bptc_between(int e0, int e1, int weight) { return ((64 - weight) * e0 + weight * e1 + 32) >> 6; }

}  // namespace tex::inline v1
