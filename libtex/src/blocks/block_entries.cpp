// SPDX-License-Identifier: Apache-2.0

#include "blocks/block_entries.h"

#include "blocks/astc_ise.h"

namespace tex::inline v1 {
namespace {

// Calls `index(texel, plane, bits)` for all indices in the order in which blocks store them.
template <class Index>
void for_each_index(const BlockEntries& entries, const Index& index) {
    const auto one = [&](unsigned texel, int plane) {
        if (entries.bits[plane] == 0) return;
        index(texel, plane, entries.bits[plane] - static_cast<int>(entries.anchors >> texel & 1u));
    };
    for (unsigned texel = 0; texel < 16; ++texel) {
        one(texel, 0);
        if (entries.is_mixed) one(texel, 1);
    }
    for (unsigned texel = 0; !entries.is_mixed && texel < 16; ++texel) one(texel, 1);
}

}  // namespace

void read_entry_numbers(const BlockEntries& entries, const std::byte* block, std::uint8_t numbers[16]) {
    const AstcBits bits = read_astc_bits(block);
    int at = entries.front;
    for (int k = 0; k < 16; ++k) numbers[k] = 0;
    for_each_index(entries, [&](unsigned texel, int plane, int count) {
        const unsigned index = bits.at(at, count);
        at += count;
        numbers[texel] = static_cast<std::uint8_t>(numbers[texel] | index << (plane == 0 ? 0 : entries.bits[0]));
    });
}

void write_entry_numbers(const BlockEntries& entries, const std::byte* block, const std::uint8_t numbers[16],
                         std::byte* out) {
    AstcBits bits = read_astc_bits(block);
    int at = entries.front;
    if (at < 64) bits.low &= (std::uint64_t{1} << at) - 1;
    bits.high = at <= 64 ? 0 : at >= 128 ? bits.high : bits.high & ((std::uint64_t{1} << (at - 64)) - 1);
    for_each_index(entries, [&](unsigned texel, int plane, int count) {
        const unsigned all = numbers[texel];
        bits.put(at, count, plane == 0 ? all & ((1u << entries.bits[0]) - 1) : all >> entries.bits[0]);
        at += count;
    });
    write_astc_bits(bits, out);
}

}  // namespace tex::inline v1
