// SPDX-License-Identifier: Apache-2.0

#include "blocks/bc6h.h"

#include <array>
#include <cstring>
#include <iterator>
#include <string_view>

#include "blocks/bc6h_modes.h"
#include "blocks/bptc.h"

namespace tex::inline v1 {
namespace {

constexpr int kEndpoints = 4;

// Where each bit of a block goes.
struct Bit {
    std::uint8_t endpoint = 0, channel = 0, shift = 0;
};
struct Layout {
    std::array<Bit, 75> bits = {};
    int count = 0;
};

constexpr int read_int(std::string_view& text) {
    int value = 0;
    for (; !text.empty() && text[0] >= '0' && text[0] <= '9'; text.remove_prefix(1))
        value = 10 * value + (text[0] - '0');
    return value;
}

// Reads the words of Bc6hMode::fields.
constexpr Layout layout_of(std::string_view fields) {
    Layout layout;
    while (!fields.empty()) {
        const int channel = fields[0] == 'r' ? 0 : fields[0] == 'g' ? 1 : 2;
        const int endpoint = fields[1] - '0';
        fields.remove_prefix(3);
        const int high = read_int(fields);
        int low = high;
        if (!fields.empty() && fields[0] == '-') {
            fields.remove_prefix(1);
            low = read_int(fields);
        }
        if (!fields.empty()) fields.remove_prefix(1);
        const int step = high >= low ? 1 : -1;
        for (int bit = low; bit != high + step; bit += step)
            layout.bits[static_cast<std::size_t>(layout.count++)] = {static_cast<std::uint8_t>(endpoint),
                                                                     static_cast<std::uint8_t>(channel),
                                                                     static_cast<std::uint8_t>(bit)};
    }
    return layout;
}

constexpr std::size_t kModeCount = std::size(kBc6hModes);

constexpr std::array<Layout, kModeCount> kLayouts = [] {
    std::array<Layout, kModeCount> layouts;
    for (std::size_t k = 0; k < kModeCount; ++k) layouts[k] = layout_of(kBc6hModes[k].fields);
    return layouts;
}();

// The row of kBc6hModes for each number; kModeCount for the reserved ones.
constexpr std::array<std::size_t, 32> kRows = [] {
    std::array<std::size_t, 32> rows = {};
    for (std::size_t& row : rows) row = kModeCount;
    for (std::size_t k = 0; k < kModeCount; ++k) rows[kBc6hModes[k].number] = k;
    return rows;
}();

// The blocks are full: two bits of the mode number or five, the endpoints, the partition, and the indices.
static_assert([] {
    for (std::size_t k = 0; k < kModeCount; ++k) {
        const Bc6hMode& mode = kBc6hModes[k];
        const int before = (mode.number < 2 ? 2 : 5) + kLayouts[k].count;
        if (before + (mode.subsets == 2 ? 5 + 46 : 63) != 128) return false;
    }
    return true;
}());

int sign_extended(int value, int bits) {
    const int sign = 1 << (bits - 1);
    return ((value & ((1 << bits) - 1)) ^ sign) - sign;
}

// An endpoint in 16 bits.
int widened_endpoint(int value, int bits, bool is_signed) {
    if (!is_signed) {
        if (bits >= 15 || value == 0) return value;
        return value == (1 << bits) - 1 ? 0xFFFF : ((value << 15) + 0x4000) >> (bits - 1);
    }
    if (bits >= 16 || value == 0) return value;
    const int size = value < 0 ? -value : value;
    const int wide = size >= (1 << (bits - 1)) - 1 ? 0x7FFF : ((size << 15) + 0x4000) >> (bits - 1);
    return value < 0 ? -wide : wide;
}

std::uint16_t half_of(int value, bool is_signed) {
    if (!is_signed) return static_cast<std::uint16_t>((value * 31) >> 6);
    return static_cast<std::uint16_t>(value < 0 ? ((-value * 31) >> 5) | 0x8000 : (value * 31) >> 5);
}

void finish_endpoints(const Bc6hMode& mode, bool is_signed, int endpoints[kEndpoints][3]) {
    const int bits = mode.endpoint_bits;
    for (int c = 0; c < 3; ++c) {
        if (is_signed) endpoints[0][c] = sign_extended(endpoints[0][c], bits);
        for (int e = 1; e < 2 * mode.subsets; ++e) {
            int& value = endpoints[e][c];
            if (mode.is_transformed)
                value = (endpoints[0][c] + sign_extended(value, mode.delta_bits[c])) & ((1 << bits) - 1);
            if (is_signed) value = sign_extended(value, bits);
        }
        for (int e = 0; e < 2 * mode.subsets; ++e) endpoints[e][c] = widened_endpoint(endpoints[e][c], bits, is_signed);
    }
}

}  // namespace

void decode_bc6h(const std::byte* block, bool is_signed, std::uint16_t rgb[16][3]) {
    BptcBits bits(block);
    unsigned number = bits.take(2);
    if (number > 1) number |= bits.take(3) << 2;
    const std::size_t row = kRows[number];
    if (row == kModeCount) {
        std::memset(rgb, 0, 16 * 3 * sizeof(std::uint16_t));
        return;
    }
    const Bc6hMode& mode = kBc6hModes[row];
    int endpoints[kEndpoints][3] = {};
    for (int k = 0; k < kLayouts[row].count; ++k) {
        const Bit bit = kLayouts[row].bits[static_cast<std::size_t>(k)];
        endpoints[bit.endpoint][bit.channel] |= static_cast<int>(bits.take(1) << bit.shift);
    }
    const unsigned partition = mode.subsets == 2 ? bits.take(5) : 0;
    finish_endpoints(mode, is_signed, endpoints);
    std::uint8_t weights[16];
    read_bptc_weights(bits, mode.subsets, partition, mode.subsets == 2 ? 3 : 4, weights);
    for (unsigned texel = 0; texel < 16; ++texel) {
        const unsigned e = 2 * bptc_subset(mode.subsets, partition, texel);
        for (int c = 0; c < 3; ++c)
            rgb[texel][c] = half_of(bptc_between(endpoints[e][c], endpoints[e + 1][c], weights[texel]), is_signed);
    }
}

}  // namespace tex::inline v1
