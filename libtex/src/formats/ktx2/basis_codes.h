// SPDX-License-Identifier: Apache-2.0
// basis_codes.h: the bits of BasisLZ, and its canonical Huffman codes (KTX 2.0, "BasisLZ/ETC1S").

#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <tex/types.h>

namespace tex::inline v1 {

// What is wrong with BasisLZ data: bad_data, without the name of the file.
[[nodiscard]] Error damaged_basis(std::string reason);

// Bits from the lowest one of the first byte. Behind the last byte they are 0; is_sound() then says so.
class BasisBits {
public:
    explicit BasisBits(std::span<const std::byte> bytes) : bytes_(bytes) {}

    // The next `count` bits, at most 16, which stay.
    [[nodiscard]] std::uint32_t peek(int count) {
        if (held_ < count) fill();
        return static_cast<std::uint32_t>(bits_ & ((std::uint64_t{1} << count) - 1));
    }
    void skip(int count) {  // bits that peek() has seen
        bits_ >>= count;
        held_ -= count;
    }
    std::uint32_t take(int count) {
        const std::uint32_t bits = peek(count);
        skip(count);
        return bits;
    }
    // A number in groups of `group` bits, the lowest first, each followed by a bit that says whether another one comes.
    std::uint32_t take_groups(int group);

    // A code that does not exist was read.
    void fail() { is_damaged_ = true; }
    // False if bits beyond the end were taken, or after fail().
    [[nodiscard]] bool is_sound() const { return !is_damaged_ && added_ <= held_; }

private:
    void fill() {
        while (held_ <= 48) {
            if (next_ < bytes_.size())
                bits_ |= std::to_integer<std::uint64_t>(bytes_[next_++]) << held_;
            else
                added_ += 8;
            held_ += 8;
        }
    }

    std::span<const std::byte> bytes_;
    std::size_t next_ = 0;
    std::uint64_t bits_ = 0;
    int held_ = 0;
    std::int64_t added_ = 0;  // bits behind the end
    bool is_damaged_ = false;
};

// The codes of symbols 0, 1, 2 ...
class BasisCodes {
public:
    // Reads the lengths of the codes, which are themselves coded. Errors: bad_data, if they make no complete code. May
    // throw std::bad_alloc.
    static Result<BasisCodes> read(BasisBits& bits);

    // Without symbols, nothing can be taken.
    [[nodiscard]] bool is_empty() const { return symbols_.empty(); }

    // Precondition: !is_empty(). A code that stands for nothing gives 0, and bits.fail().
    [[nodiscard]] std::uint32_t take(BasisBits& bits) const {
        const std::uint32_t ahead = bits.peek(kLongest);
        const Short entry = short_[ahead & ((1u << kShort) - 1)];
        if (entry.bits == 0) return take_long(bits, ahead);
        bits.skip(entry.bits);
        return entry.symbol;
    }

private:
    static constexpr int kLongest = 16;
    static constexpr int kShort = 10;

    struct Short {
        std::uint16_t symbol = 0;
        std::uint16_t bits = 0;  // 0: the code is longer, or there is none
    };
    // Codes of one length are consecutive numbers, read from the highest bit.
    struct Length {
        std::uint32_t first = 0, count = 0, at = 0;  // at: of the first symbol, in symbols_
    };

    static Result<BasisCodes> from_lengths(std::span<const std::uint8_t> lengths);
    [[nodiscard]] std::uint32_t take_long(BasisBits& bits, std::uint32_t ahead) const;

    std::vector<std::uint16_t> symbols_;  // by the length of their code
    std::vector<Short> short_;
    Length lengths_[kLongest + 1];
};

}  // namespace tex::inline v1
