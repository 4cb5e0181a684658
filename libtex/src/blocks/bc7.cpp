// SPDX-License-Identifier: Apache-2.0

#include "blocks/bc7.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include "blocks/bc7_modes.h"
#include "blocks/block_entries.h"
#include "blocks/bptc.h"

namespace tex::inline v1 {
namespace {

constexpr int kMostEndpoints = 6;

// A code of `bits` bits, at least 4, as one of 8: its highest bits are repeated.
int widened_to_8(unsigned code, int bits) {
    const unsigned high = code << (8 - bits);
    return static_cast<int>(high | high >> bits);
}

void read_endpoints(BptcBits& bits, const Bc7Mode& mode, int endpoints[kMostEndpoints][4]) {
    const int count = 2 * mode.subsets;
    unsigned codes[kMostEndpoints][4] = {};
    for (int c = 0; c < 4; ++c) {
        for (int e = 0; e < count; ++e) codes[e][c] = bits.take(c < 3 ? mode.color : mode.alpha);
    }
    unsigned lowest[kMostEndpoints] = {};
    for (int e = 0; e < count && mode.own_p != 0; ++e) lowest[e] = bits.take(1);
    for (int e = 0; e < count && mode.shared_p != 0; e += 2) lowest[e] = lowest[e + 1] = bits.take(1);
    const int more = mode.own_p + mode.shared_p;
    for (int e = 0; e < count; ++e) {
        for (int c = 0; c < 4; ++c) {
            const int stored = c < 3 ? mode.color : mode.alpha;
            endpoints[e][c] =
                stored == 0 ? 255 : widened_to_8(more != 0 ? codes[e][c] << 1 | lowest[e] : codes[e][c], stored + more);
        }
    }
}

// The weight of an index of so many bits.
int bc7_weight(int index, int bits) {
    const int steps = (1 << bits) - 1;
    return (2 * 64 * index + steps) / (2 * steps);
}

}  // namespace

void decode_bc7(const std::byte* block, std::uint8_t rgba[16][4]) {
    const int number = std::countr_zero(std::to_integer<unsigned>(block[0]));
    if (block[0] == std::byte{0}) {
        std::memset(rgba, 0, 64);
        return;
    }
    const Bc7Mode& mode = kBc7Modes[number];
    BptcBits bits(block);
    bits.take(number + 1);
    const unsigned partition = bits.take(mode.partition), rotation = bits.take(mode.rotation);
    const bool is_exchanged = bits.take(mode.selection) != 0;
    int endpoints[kMostEndpoints][4];
    read_endpoints(bits, mode, endpoints);
    std::uint8_t first[16], second[16];
    read_bptc_weights(bits, mode.subsets, partition, mode.index, first);
    if (mode.second_index != 0)
        read_bptc_weights(bits, 1, 0, mode.second_index, second);
    else
        std::copy_n(first, 16, second);
    const std::uint8_t* const color = is_exchanged ? second : first;
    const std::uint8_t* const alpha = is_exchanged ? first : second;
    for (unsigned texel = 0; texel < 16; ++texel) {
        const unsigned e = 2 * bptc_subset(mode.subsets, partition, texel);
        for (int c = 0; c < 4; ++c) {
            const int weight = c < 3 ? color[texel] : alpha[texel];
            rgba[texel][c] = static_cast<std::uint8_t>(bptc_between(endpoints[e][c], endpoints[e + 1][c], weight));
        }
        if (rotation != 0) std::swap(rgba[texel][3], rgba[texel][rotation - 1]);
    }
}

BlockEntries read_bc7_entries(const std::byte* block) {
    BlockEntries entries;
    if (block[0] == std::byte{0}) return entries;
    const int number = std::countr_zero(std::to_integer<unsigned>(block[0]));
    const Bc7Mode& mode = kBc7Modes[number];
    BptcBits bits(block);
    bits.take(number + 1);
    const unsigned partition = bits.take(mode.partition), rotation = bits.take(mode.rotation);
    const bool is_exchanged = bits.take(mode.selection) != 0;
    int ends[kMostEndpoints][4];
    read_endpoints(bits, mode, ends);

    const int count = 2 * mode.subsets;
    entries.front = number + 1 + mode.partition + mode.rotation + mode.selection +
                    count * (3 * mode.color + mode.alpha + mode.own_p) + mode.subsets * mode.shared_p;
    entries.bits[0] = mode.index;
    entries.bits[1] = mode.second_index;
    entries.subsets = mode.subsets;
    entries.count = 1 << (mode.index + mode.second_index);
    entries.anchors = bptc_anchors(mode.subsets, partition);
    for (unsigned texel = 0; texel < 16; ++texel)
        entries.subset[texel] = static_cast<std::uint8_t>(bptc_subset(mode.subsets, partition, texel));
    for (int n = 0; n < entries.total(); ++n) {
        const int s = n / entries.count, e = n % entries.count;
        int color = bc7_weight(e & ((1 << mode.index) - 1), mode.index), alpha = color;
        if (mode.second_index != 0) alpha = bc7_weight(e >> mode.index, mode.second_index);
        if (is_exchanged) std::swap(color, alpha);
        for (int c = 0; c < 4; ++c) {
            entries.code[n][c] =
                static_cast<std::uint8_t>(bptc_between(ends[2 * s][c], ends[2 * s + 1][c], c < 3 ? color : alpha));
        }
        if (rotation != 0) std::swap(entries.code[n][3], entries.code[n][rotation - 1]);
    }
    return entries;
}

}  // namespace tex::inline v1
