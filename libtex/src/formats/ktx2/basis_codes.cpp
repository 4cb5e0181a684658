// SPDX-License-Identifier: Apache-2.0

#include "formats/ktx2/basis_codes.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

namespace tex::inline v1 {
namespace {

constexpr int kSymbolBits = 14;  // of the number of symbols

// The symbols of the code for lengths: 0 to 16 are lengths, the others repeat.
constexpr std::size_t kLengthSymbols = 21;
constexpr std::uint8_t kLengthOrder[kLengthSymbols] = {17, 18, 19, 20, 0,  8, 7,  9, 6,  10, 5,
                                                       11, 4,  12, 3,  13, 2, 14, 1, 15, 16};
struct Repeat {
    int bits;
    std::uint32_t least;
    bool of_last;  // length; else of 0
};
constexpr std::uint32_t kFirstRepeat = 17;
constexpr Repeat kRepeats[] = {{3, 3, false}, {7, 11, false}, {2, 3, true}, {7, 7, true}};

std::uint32_t reversed(std::uint32_t bits, int count) {
    std::uint32_t result = 0;
    for (; count > 0; --count, bits >>= 1) result = result << 1 | (bits & 1);
    return result;
}

}  // namespace

Error damaged_basis(std::string reason) { return {ErrorCode::bad_data, {}, "BasisLZ: " + std::move(reason)}; }

std::uint32_t BasisBits::take_groups(int group) {
    std::uint32_t value = 0;
    for (int at = 0; at < 32; at += group) {
        const std::uint32_t bits = take(group + 1);
        value |= (bits & ((1u << group) - 1)) << at;
        if (bits >> group == 0) break;
    }
    return value;
}

Result<BasisCodes> BasisCodes::from_lengths(std::span<const std::uint8_t> lengths) {
    BasisCodes codes;
    for (const std::uint8_t length : lengths) codes.lengths_[length].count += length > 0 ? 1 : 0;
    std::uint32_t used = 0, taken = 0, next = 0;  // taken: of all codes of the longest length
    for (int k = 1; k <= kLongest; ++k) {
        Length& of = codes.lengths_[k];
        next = (next + codes.lengths_[k - 1].count) << 1;
        of.first = next;
        of.at = used;
        used += of.count;
        taken += of.count << (kLongest - k);
    }
    if (taken != 1u << kLongest && used != 1) return damaged_basis("a Huffman code is not complete");
    codes.symbols_.resize(used);
    codes.short_.resize(std::size_t{1} << kShort);
    std::uint32_t given[kLongest + 1] = {};
    for (std::size_t symbol = 0; symbol < lengths.size(); ++symbol) {
        const int length = lengths[symbol];
        if (length == 0) continue;
        const Length& of = codes.lengths_[length];
        const std::uint32_t k = given[length]++;
        codes.symbols_[of.at + k] = static_cast<std::uint16_t>(symbol);
        if (length > kShort) continue;
        for (std::uint32_t at = reversed(of.first + k, length); at < codes.short_.size(); at += 1u << length)
            codes.short_[at] = {static_cast<std::uint16_t>(symbol), static_cast<std::uint16_t>(length)};
    }
    return codes;
}

std::uint32_t BasisCodes::take_long(BasisBits& bits, std::uint32_t ahead) const {
    const std::uint32_t code = reversed(ahead, kLongest);
    for (int length = kShort + 1; length <= kLongest; ++length) {
        const Length& of = lengths_[length];
        const std::uint32_t k = (code >> (kLongest - length)) - of.first;  // huge for smaller codes
        if (k >= of.count) continue;
        bits.skip(length);
        return symbols_[of.at + k];
    }
    bits.fail();
    return 0;
}

Result<BasisCodes> BasisCodes::read(BasisBits& bits) {
    const std::size_t count = bits.take(kSymbolBits);
    if (count == 0) return BasisCodes();
    const std::size_t of_lengths = bits.take(5);
    if (of_lengths == 0 || of_lengths > kLengthSymbols) return damaged_basis("a Huffman code has no lengths");
    std::uint8_t short_lengths[kLengthSymbols] = {};
    for (std::size_t k = 0; k < of_lengths; ++k)
        short_lengths[kLengthOrder[k]] = static_cast<std::uint8_t>(bits.take(3));
    const Result<BasisCodes> by_lengths = from_lengths(short_lengths);
    if (!by_lengths) return by_lengths.error();

    std::vector<std::uint8_t> lengths;
    lengths.reserve(count);
    while (lengths.size() < count) {
        const std::uint32_t symbol = by_lengths->take(bits);
        if (!bits.is_sound()) return damaged_basis("the lengths of a Huffman code end too early");
        if (symbol < kFirstRepeat) {
            lengths.push_back(static_cast<std::uint8_t>(symbol));
            continue;
        }
        const Repeat& repeat = kRepeats[symbol - kFirstRepeat];
        const std::uint32_t times = repeat.least + bits.take(repeat.bits);
        if (repeat.of_last && (lengths.empty() || lengths.back() == 0))
            return damaged_basis("a Huffman code repeats a length before there is one");
        if (times > count - lengths.size()) return damaged_basis("a Huffman code has too many lengths");
        lengths.insert(lengths.end(), times, repeat.of_last ? lengths.back() : std::uint8_t{0});
    }
    return from_lengths(lengths);
}

}  // namespace tex::inline v1
