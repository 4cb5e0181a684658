// SPDX-License-Identifier: Apache-2.0

#include "formats/ktx2/basis_codebooks.h"

#include <utility>

#include "blocks/etc1s.h"
#include "formats/bytes.h"

namespace tex::inline v1 {
namespace {

std::uint32_t load_u16(const std::byte* p) {
    return std::to_integer<std::uint32_t>(p[0]) | std::to_integer<std::uint32_t>(p[1]) << 8;
}

// Reads a code that must have symbols.
Result<BasisCodes> read_used(BasisBits& bits) {
    Result<BasisCodes> codes = BasisCodes::read(bits);
    if (codes && codes->is_empty()) return damaged_basis("a Huffman code has no symbols");
    return codes;
}

// Each component of a base colour is coded as the difference from the one before, by one of three codes, according to
// where that stands.
constexpr int kColorCodes = 3;
int color_code(unsigned before) { return before <= 9 ? 0 : before <= 21 ? 1 : 2; }

Result<void> read_endpoints(std::span<const std::byte> bytes, std::size_t count, BasisCodebooks& books) {
    BasisBits bits(bytes);
    BasisCodes color[kColorCodes], table;
    for (BasisCodes* const codes : {&color[0], &color[1], &color[2], &table}) {
        Result<BasisCodes> read = read_used(bits);
        if (!read) return read.error();
        *codes = std::move(*read);
    }
    const int channels = bits.take(1) != 0 ? 1 : 3;  // 1: all endpoints are grey
    std::uint8_t last[3] = {16, 16, 16}, last_table = 0;
    books.endpoints.resize(count);
    for (BasisCodebooks::Half& endpoint : books.endpoints) {
        last_table = static_cast<std::uint8_t>((last_table + table.take(bits)) & 7);
        for (int c = 0; c < channels; ++c)
            last[c] = static_cast<std::uint8_t>((last[c] + color[color_code(last[c])].take(bits)) & 31);
        if (channels == 1) last[1] = last[2] = last[0];
        write_etc1s_color(last, last_table, endpoint.data());
    }
    return bits.is_sound() ? Result<void>() : damaged_basis("the endpoints are damaged or end too early");
}

Result<void> read_selectors(std::span<const std::byte> bytes, std::size_t count, BasisCodebooks& books) {
    BasisBits bits(bytes);
    const bool is_global = bits.take(1) != 0, is_hybrid = bits.take(1) != 0, is_raw = bits.take(1) != 0;
    if (is_global || is_hybrid)
        return Error{ErrorCode::unsupported, {}, "BasisLZ with a global codebook of selectors is not supported"};
    BasisCodes changes;
    if (!is_raw) {
        Result<BasisCodes> read = BasisCodes::read(bits);
        if (!read) return read.error();
        if (read->is_empty() && count > 1) return damaged_basis("a Huffman code has no symbols");
        changes = std::move(*read);
    }
    std::uint8_t rows[4] = {};
    books.selectors.resize(count);
    for (std::size_t k = 0; k < count; ++k) {
        for (std::uint8_t& row : rows) {
            const std::uint32_t read = is_raw || k == 0 ? bits.take(8) : changes.take(bits) ^ row;
            row = static_cast<std::uint8_t>(read & 255);
        }
        write_etc1s_modifiers(rows, books.selectors[k].data());
    }
    return bits.is_sound() ? Result<void>() : damaged_basis("the selectors are damaged or end too early");
}

Result<void> read_tables(std::span<const std::byte> bytes, BasisCodebooks& books) {
    BasisBits bits(bytes);
    for (BasisCodes* const codes : {&books.prediction, &books.endpoint_step, &books.selector, &books.selector_run}) {
        Result<BasisCodes> read = read_used(bits);
        if (!read) return read.error();
        *codes = std::move(*read);
    }
    books.history = bits.take(13);
    if (!bits.is_sound()) return damaged_basis("the tables end too early");
    return books.history > 0 ? Result<void>() : damaged_basis("no selectors are remembered");
}

}  // namespace

BasisImage read_basis_image(const std::byte* bytes) {
    constexpr std::uint32_t kFollows = 2;
    const auto field = [&](std::size_t k) { return load_u32(bytes + 4 * k); };
    return {(field(0) & kFollows) != 0, field(1), field(2), field(3), field(4)};
}

Result<BasisCodebooks> read_basis_codebooks(std::span<const std::byte> head, std::span<const std::byte> rest) {
    if (head.size() < kBasisHeaderBytes) return damaged_basis("the global data end too early");
    const std::size_t endpoints = load_u16(head.data()), selectors = load_u16(head.data() + 2);
    if (endpoints == 0 || selectors == 0) return damaged_basis("a codebook is empty");
    std::span<const std::byte> parts[3];
    for (std::size_t k = 0, at = 0; k < 3; ++k) {
        const std::size_t count = load_u32(head.data() + 4 + 4 * k);
        if (count > rest.size() - at) return damaged_basis("the codebooks are longer than the global data");
        parts[k] = rest.subspan(at, count);
        at += count;
    }
    BasisCodebooks books;
    if (Result<void> read = read_endpoints(parts[0], endpoints, books); !read) return read.error();
    if (Result<void> read = read_selectors(parts[1], selectors, books); !read) return read.error();
    if (Result<void> read = read_tables(parts[2], books); !read) return read.error();
    return books;
}

}  // namespace tex::inline v1
