// SPDX-License-Identifier: Apache-2.0
// block_entries.h: a block of BC7 or UASTC as a choice: the index of each texel (or both, where there are two planes)
// picks one of the entries of its subset. So what is in front of the indices can be kept, and texels choose again.

#pragma once

#include <cstddef>
#include <cstdint>

namespace tex::inline v1 {

// Entries of a subset are numbered by first index + first levels * second index.
struct BlockEntries {
    static constexpr int kMost = 32;

    int front = 128;             // bits before the indices
    int bits[2] = {};            // of each index; blocks of one colour have none
    bool is_mixed = false;       // the indices of a texel follow each other, else those of the second plane come last
    int subsets = 1, count = 1;  // entries of each subset
    std::uint8_t subset[16] = {};
    unsigned anchors = 0;              // texels whose indices lack their highest bits
    std::uint8_t code[kMost][4] = {};  // RGBA of entry e of subset s, at s * count + e

    [[nodiscard]] int total() const { return subsets * count; }
    // The whole bytes in front of the indices.
    [[nodiscard]] int front_bytes() const { return front / 8; }
    // The first byte after which there is nothing but indices.
    [[nodiscard]] int first_index_byte() const { return (front + 7) / 8; }
    // Whether texels that are anchors cannot take this entry.
    [[nodiscard]] bool is_high(int entry) const {
        const int first = entry & ((1 << bits[0]) - 1), second = entry >> bits[0];
        return (bits[0] > 0 && first >> (bits[0] - 1) != 0) || (bits[1] > 0 && second >> (bits[1] - 1) != 0);
    }
};

[[nodiscard]] BlockEntries read_bc7_entries(const std::byte* block);
[[nodiscard]] BlockEntries read_uastc_entries(const std::byte* block);

// The entry, of its subset, that each texel has.
void read_entry_numbers(const BlockEntries& entries, const std::byte* block, std::uint8_t numbers[16]);

// Writes the block whose entries these are with other numbers. Precondition: no anchor has a high one.
void write_entry_numbers(const BlockEntries& entries, const std::byte* block, const std::uint8_t numbers[16],
                         std::byte* out);

}  // namespace tex::inline v1
