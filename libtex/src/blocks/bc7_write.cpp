// SPDX-License-Identifier: Apache-2.0

#include "blocks/bc7_write.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "blocks/bc7_modes.h"
#include "blocks/bptc.h"

namespace tex::inline v1 {
namespace {

// The bits of a block, from the lowest one.
class Bc7Writer {
public:
    void put(unsigned value, int count) {
        const auto bits = static_cast<std::uint64_t>(value);
        if (at_ < 64) low_ |= bits << at_;
        if (at_ >= 64) high_ |= bits << (at_ - 64);
        if (at_ < 64 && at_ + count > 64) high_ |= bits >> (64 - at_);
        at_ += count;
    }

    void store(std::byte* block) const {
        for (int k = 0; k < 8; ++k) {
            block[k] = static_cast<std::byte>(low_ >> (8 * k));
            block[8 + k] = static_cast<std::byte>(high_ >> (8 * k));
        }
    }

private:
    std::uint64_t low_ = 0, high_ = 0;
    int at_ = 0;
};

// Makes the index of an anchor fit into one bit less. `first` and `last`: the channels that these indices interpolate.
void turn(Bc7Content& content, int subsets, int subset, std::uint8_t* indices, int bits, int first, int last) {
    const unsigned texels = subsets == 1 ? 0xffffu : bptc_texels(subsets, content.partition, subset);
    const int anchor = std::countr_zero(texels & bptc_anchors(subsets, content.partition));
    if (indices[anchor] >> (bits - 1) == 0) return;
    for (unsigned left = texels; left != 0; left &= left - 1) {
        std::uint8_t& index = indices[std::countr_zero(left)];
        index = static_cast<std::uint8_t>((1 << bits) - 1 - index);
    }
    for (int c = first; c < last; ++c) std::swap(content.ends[subset][0][c], content.ends[subset][1][c]);
}

void put_indices(Bc7Writer& to, int subsets, unsigned partition, const std::uint8_t* indices, int bits) {
    const unsigned anchors = bptc_anchors(subsets, partition);
    for (unsigned texel = 0; texel < 16; ++texel)
        to.put(indices[texel], bits - static_cast<int>(anchors >> texel & 1u));
}

}  // namespace

void write_bc7(const Bc7Content& given, std::byte* block) {
    Bc7Content content = given;
    const Bc7Mode& mode = kBc7Modes[content.mode];
    const bool two_planes = mode.second_index != 0;
    const int color_bits = content.is_exchanged ? mode.second_index : mode.index;
    const int alpha_bits = content.is_exchanged ? mode.index : mode.second_index;
    for (int subset = 0; subset < mode.subsets; ++subset)
        turn(content, mode.subsets, subset, content.color, color_bits, 0, two_planes ? 3 : 4);
    if (two_planes) turn(content, 1, 0, content.alpha, alpha_bits, 3, 4);

    Bc7Writer to;
    to.put(1u << content.mode, content.mode + 1);
    to.put(content.partition, mode.partition);
    to.put(content.rotation, mode.rotation);
    to.put(content.is_exchanged ? 1 : 0, mode.selection);
    const int apart = mode.own_p + mode.shared_p, count = 2 * mode.subsets;
    for (int c = 0; c < (mode.alpha == 0 ? 3 : 4); ++c) {
        for (int e = 0; e < count; ++e) to.put(content.ends[e / 2][e % 2][c] >> apart, c < 3 ? mode.color : mode.alpha);
    }
    for (int e = 0; apart != 0 && e < count; e += 1 + mode.shared_p) to.put(content.ends[e / 2][e % 2][0] & 1u, 1);
    const std::uint8_t *first = content.color, *second = content.alpha;
    if (content.is_exchanged) std::swap(first, second);
    put_indices(to, mode.subsets, content.partition, first, mode.index);
    if (two_planes) put_indices(to, 1, 0, second, mode.second_index);
    to.store(block);
}

}  // namespace tex::inline v1
