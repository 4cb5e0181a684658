// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include "mesh/meshopt_buffers.h"

namespace tex::inline v1 {
namespace {

constexpr std::size_t kMostInBlock = 256, kGroup = 16;

// Takes bytes from the front; a read past the end makes it fail, and then gives zeros.
class ByteReader {
public:
    explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

    std::span<const std::byte> take(std::size_t count) {
        if (count > bytes_.size()) {
            failed_ = true;
            bytes_ = {};
            return {};
        }
        const auto taken = bytes_.first(count);
        bytes_ = bytes_.subspan(count);
        return taken;
    }
    [[nodiscard]] bool failed() const { return failed_; }
    [[nodiscard]] std::size_t left() const { return bytes_.size(); }

private:
    std::span<const std::byte> bytes_;
    bool failed_ = false;
};

using Column = std::array<std::uint8_t, kMostInBlock>;  // one byte of each element of a block

// 16 values of `bits` bits. The greatest one means that a whole byte follows the group.
void read_group(ByteReader& from, unsigned bits, std::uint8_t* to) {
    if (bits == 0) return static_cast<void>(std::fill_n(to, kGroup, std::uint8_t{0}));
    const auto packed = from.take(kGroup * bits / 8);
    if (from.failed()) return;
    const unsigned per_byte = 8 / bits, escape = (1u << bits) - 1;
    for (unsigned k = 0; k < kGroup; ++k) {
        const auto byte = std::to_integer<unsigned>(packed[k / per_byte]);
        const unsigned place = k % per_byte;
        // Single bits begin at the lowest one, all others at the highest.
        const unsigned shift = bits == 1 ? place : 8 - bits * (place + 1);
        unsigned value = byte >> shift & escape;
        if (bits < 8 && value == escape) {
            const auto whole = from.take(1);
            if (from.failed()) return;
            value = std::to_integer<unsigned>(whole[0]);
        }
        to[k] = static_cast<std::uint8_t>(value);
    }
}

// A column in groups, after two bits for each group that choose one of four widths.
void read_groups(ByteReader& from, std::size_t count, const std::array<unsigned, 4>& widths, Column& column) {
    constexpr std::size_t kInByte = 4;
    const std::size_t groups = (count + kGroup - 1) / kGroup;
    const auto header = from.take((groups + kInByte - 1) / kInByte);
    for (std::size_t g = 0; g < groups && !from.failed(); ++g) {
        const unsigned choice = std::to_integer<unsigned>(header[g / kInByte]) >> (g % kInByte * 2) & 3;
        read_group(from, widths[choice], column.data() + g * kGroup);
    }
}

void read_column(ByteReader& from, std::size_t count, int version, unsigned control, Column& column) {
    constexpr std::array<unsigned, 4> kWidths0 = {0, 2, 4, 8}, kWidths1 = {0, 1, 2, 4}, kWidths2 = {1, 2, 4, 8};
    if (version == 0) return read_groups(from, count, kWidths0, column);
    if (control < 2) return read_groups(from, count, control == 0 ? kWidths1 : kWidths2, column);
    if (control == 2) return column.fill(0);
    const auto plain = from.take(count);
    for (std::size_t k = 0; k < plain.size(); ++k) column[k] = std::to_integer<std::uint8_t>(plain[k]);
}

// Four bytes of each element: the differences, as numbers of `size` bytes, become values. Channel types: 0 bytes, 1
// numbers of two bytes, 2 exclusive or of rotated numbers of four bytes.
void add_differences(const std::array<Column, 4>& columns, std::size_t count, std::size_t stride, unsigned channel,
                     std::byte* last, std::byte* to) {
    const std::size_t size = std::size_t{1} << (channel & 3);
    const auto bits = static_cast<unsigned>(size) * 8;
    const std::uint32_t mask = size == 4 ? 0xffffffffu : (1u << bits) - 1;
    for (std::size_t k = 0; k < 4; k += size) {
        std::uint32_t before = 0;
        for (std::size_t b = size; b-- > 0;) before = before << 8 | std::to_integer<std::uint32_t>(last[k + b]);
        for (std::size_t i = 0; i < count; ++i) {
            std::uint32_t value = 0;
            for (std::size_t b = size; b-- > 0;) value = value << 8 | columns[k + b][i];
            if (size == 4) {
                value = std::rotr(value, static_cast<int>(channel >> 4)) ^ before;
            } else {
                value = (((value >> 1) ^ (0u - (value & 1))) + before) & mask;
            }
            for (std::size_t b = 0; b < size; ++b)
                to[i * stride + k + b] = static_cast<std::byte>(value >> (8 * b) & 0xff);
            before = value;
        }
        for (std::size_t b = 0; b < size; ++b) last[k + b] = static_cast<std::byte>(before >> (8 * b) & 0xff);
    }
}

}  // namespace

bool decode_meshopt_attributes(std::span<const std::byte> bytes, std::size_t stride, std::vector<std::byte>& to) {
    if (bytes.empty() || (std::to_integer<int>(bytes[0]) & 0xf0) != 0xa0) return false;
    const int version = std::to_integer<int>(bytes[0]) & 0xf;
    if (version > 1) return false;
    // The end: padding, the first element, and for each four bytes the type of the channel.
    const std::size_t tail = stride + (version == 0 ? 0 : stride / 4);
    const std::size_t padded = std::max<std::size_t>(tail, version == 0 ? 32 : 24);
    if (bytes.size() - 1 < padded) return false;
    std::vector<std::byte> last(bytes.end() - static_cast<std::ptrdiff_t>(tail), bytes.end());
    const std::vector<std::byte> channels(last.begin() + static_cast<std::ptrdiff_t>(stride), last.end());
    for (const std::byte channel : channels) {
        if ((std::to_integer<unsigned>(channel) & 3) == 3) return false;
    }
    ByteReader from(bytes.subspan(1, bytes.size() - 1 - padded));
    const std::size_t count = to.size() / stride;
    const std::size_t in_block = std::min(kMostInBlock, 8192 / stride / kGroup * kGroup);
    std::array<Column, 4> columns{};
    for (std::size_t first = 0; first < count; first += in_block) {
        const std::size_t here = std::min(in_block, count - first);
        const auto control = from.take(version == 0 ? 0 : stride / 4);
        for (std::size_t k = 0; k < stride && !from.failed(); k += 4) {
            const unsigned controls = version == 0 ? 0 : std::to_integer<unsigned>(control[k / 4]);
            for (unsigned b = 0; b < 4; ++b) read_column(from, here, version, controls >> (2 * b) & 3, columns[b]);
            const unsigned channel = version == 0 ? 0 : std::to_integer<unsigned>(channels[k / 4]);
            add_differences(columns, here, stride, channel, last.data() + k, to.data() + first * stride + k);
        }
        if (from.failed()) return false;
    }
    return from.left() == 0;
}

}  // namespace tex::inline v1
