// SPDX-License-Identifier: Apache-2.0

#include "formats/exr/exr_dwa.h"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <vector>

namespace tex {
namespace {

enum class Scheme { rest, cosine, runs };
enum class AcCoding : std::uint64_t { huffman, deflate };

// The header of a chunk: eleven numbers.
struct Head {
    std::uint64_t version, rest_bytes, rest_packed, ac_packed, dc_packed, runs_packed, runs_bytes, runs_unrolled,
        ac_count, dc_count, ac_coding;
};

constexpr int kNoColor = -1;  // otherwise 0, 1, 2: red, green and blue of one layer are decoded together

// How a chunk codes channels with this suffix and this type of values. With `any_case`, the suffix is compared in lower
// case.
struct Rule {
    std::string suffix;
    Scheme scheme = Scheme::rest;
    int type = 0;
    bool any_case = false;
    int color = kNoColor;
};

// Reads bytes one after the other. A read beyond the end returns nothing.
class Cursor {
public:
    explicit Cursor(std::span<const std::byte> bytes) : bytes_(bytes) {}

    std::optional<std::span<const std::byte>> take(std::uint64_t count) {
        if (count > bytes_.size()) return std::nullopt;
        const auto taken = bytes_.first(static_cast<std::size_t>(count));
        bytes_ = bytes_.subspan(static_cast<std::size_t>(count));
        return taken;
    }
    template <class T>
    bool read(T& value) {
        const auto taken = take(sizeof value);
        if (taken) std::memcpy(&value, taken->data(), sizeof value);
        return taken.has_value();
    }
    [[nodiscard]] bool empty() const { return bytes_.empty(); }

private:
    std::span<const std::byte> bytes_;
};

std::string small_letters(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return text;
}

// The rules of chunks that do not contain any (versions 0 and 1).
std::vector<Rule> first_rules() {
    std::vector<Rule> rules;
    for (const std::string name : {"r", "red", "g", "grn", "green", "b", "blu", "blue", "y", "by", "ry"}) {
        const auto color = name.ends_with('y') ? std::string::npos : std::string("rgb").find(name[0]);
        for (const int type : {Imf::HALF, Imf::FLOAT})
            rules.push_back({name, Scheme::cosine, type, true, static_cast<int>(color)});
    }
    for (const int type : {Imf::UINT, Imf::HALF, Imf::FLOAT}) rules.push_back({"a", Scheme::runs, type, true});
    return rules;
}

// Reads the rules. Each is a name that ends with a zero; a byte with the colour plus 1 in bits 4 to 7, the scheme in
// bits 2 and 3 and `any_case` in bit 0; and a byte with the type.
std::optional<std::vector<Rule>> read_rules(Cursor& chunk) {
    std::uint16_t bytes = 0;  // of the rules, including this number
    if (!chunk.read(bytes) || bytes < sizeof bytes) return std::nullopt;
    const auto all = chunk.take(bytes - sizeof bytes);
    if (!all) return std::nullopt;
    std::vector<Rule> rules;
    for (Cursor in(*all); !in.empty();) {
        Rule rule;
        char c = 0;
        while (in.read(c) && c != 0) rule.suffix += c;
        std::uint8_t bits = 0;
        std::uint8_t type = 0;
        if (!in.read(bits) || !in.read(type)) return std::nullopt;
        rule.scheme = static_cast<Scheme>(bits >> 2 & 3);
        rule.any_case = (bits & 1) != 0;
        rule.color = (bits >> 4) - 1;
        rule.type = type;
        rules.push_back(std::move(rule));
    }
    return rules;
}

// What the rules state for one channel. If several rules match, the last one applies.
struct Coding {
    Scheme scheme = Scheme::rest;
    int rules = 0;  // number of rules that match
    int color = kNoColor;
    std::string layer;
};

Coding coding_of(const std::vector<Rule>& rules, const std::string& name, Imf::PixelType type) {
    const std::size_t suffix_at = name.find_last_of('.') + 1;
    const std::string suffix = name.substr(suffix_at);
    Coding coding;
    coding.layer = name.substr(0, suffix_at);
    for (const Rule& rule : rules) {
        if (rule.type != type || rule.suffix != (rule.any_case ? small_letters(suffix) : suffix)) continue;
        coding.scheme = rule.scheme;
        coding.color = rule.color;
        ++coding.rules;
    }
    return coding;
}

// Whether all cosine terms of the chunk are decoded together, as those of one channel or of the three colours of a
// layer. OpenEXR knows the end of the terms only for its first decoder.
bool are_decoded_at_once(const std::vector<Coding>& codings) {
    std::vector<const Coding*> cosine;
    std::size_t colors = 0;
    for (const Coding& coding : codings) {
        if (coding.rules > 1) return false;
        if (coding.scheme == Scheme::cosine) cosine.push_back(&coding);
        colors += coding.color != kNoColor;
    }
    if (cosine.size() == 1) return true;
    unsigned seen = 0;
    for (const Coding* coding : cosine) {
        if (coding->color >= 0 && coding->layer == cosine[0]->layer) seen |= 1u << coding->color;
    }
    return cosine.size() == 3 && colors == 3 && seen == 7;
}

// Inflates data that zlib has compressed: at most the first `most` bytes; nullopt if the data are damaged.
std::optional<std::vector<std::byte>> inflated(std::span<const std::byte> packed, std::uint64_t most) {
    const std::unique_ptr<libdeflate_decompressor, void (*)(libdeflate_decompressor*)> inflater(
        libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
    if (!inflater) throw std::bad_alloc();
    std::vector<std::byte> bytes(static_cast<std::size_t>(most));
    std::size_t size = bytes.size();
    const libdeflate_result result =
        libdeflate_zlib_decompress(inflater.get(), packed.data(), packed.size(), bytes.data(), bytes.size(), &size);
    if (result == LIBDEFLATE_INSUFFICIENT_SPACE) return bytes;
    if (result != LIBDEFLATE_SUCCESS) return std::nullopt;
    bytes.resize(size);
    return bytes;
}

// Huffman coding. A table of code lengths comes first, six bits for each symbol: 59 to 62 stand for 2 to 5 unused
// symbols; 63, followed by eight bits, stands for 6 or more. The codes follow. The symbol `run_mark`, followed by eight
// bits, repeats the previous symbol. Codes of the same length are consecutive numbers; shorter codes lie above longer
// ones.

class Bits {
public:
    explicit Bits(std::span<const std::byte> bytes) : bytes_(bytes), left_(8 * bytes.size()) {}
    [[nodiscard]] std::size_t left() const { return left_; }
    [[nodiscard]] unsigned take(int count) {  // zeros beyond the end
        unsigned value = 0;
        for (; count > 0; --count) value = value << 1 | next();
        return value;
    }
    // Skips to the next whole byte.
    void align() { left_ -= left_ % 8; }

private:
    unsigned next() {
        if (left_ == 0) return 0;
        const std::size_t at = 8 * bytes_.size() - left_--;
        return static_cast<unsigned>(bytes_[at / 8]) >> (7 - at % 8) & 1;
    }
    std::span<const std::byte> bytes_;
    std::size_t left_;
};

class HuffmanTable {
public:
    HuffmanTable(Bits& bits, std::uint32_t first, std::uint32_t last) {
        for (std::uint32_t symbol = first; symbol <= last && bits.left() > 0;) {
            const unsigned length = bits.take(6);
            if (length == 63)
                symbol += bits.take(8) + 6;
            else if (length >= 59)
                symbol += length - 57;
            else
                symbols_[length].push_back(symbol++);
        }
        bits.align();
        symbols_[0].clear();
        std::uint64_t code = 0;
        for (std::size_t length = kLongest; length > 0; --length) {
            lowest_[length] = code;
            code = (code + symbols_[length].size()) >> 1;
        }
    }
    [[nodiscard]] std::optional<std::uint32_t> next(Bits& bits) const {
        std::uint64_t code = 0;
        for (std::size_t length = 1; length <= kLongest && bits.left() > 0; ++length) {
            code = code << 1 | bits.take(1);
            if (code >= lowest_[length] && code - lowest_[length] < symbols_[length].size())
                return symbols_[length][code - lowest_[length]];
        }
        return std::nullopt;
    }

private:
    static constexpr std::size_t kLongest = 58;
    std::array<std::vector<std::uint32_t>, kLongest + 1> symbols_;  // by the length of their code
    std::array<std::uint64_t, kLongest + 1> lowest_ = {};           // the lowest code of each length
};

std::vector<std::uint16_t> unpack_huffman(std::span<const std::byte> packed, std::uint64_t count) {
    struct {
        std::uint32_t first, run_mark, table_bytes, bits, unused;
    } head{};
    constexpr std::uint32_t kSymbols = 1u << 16;
    std::vector<std::uint16_t> values;
    Cursor in(packed);
    if (!in.read(head) || head.run_mark > kSymbols) return values;
    Bits bits(packed.subspan(sizeof head));
    const HuffmanTable table(bits, head.first, head.run_mark);
    while (values.size() < count) {
        const auto symbol = table.next(bits);
        if (!symbol) break;
        if (*symbol != head.run_mark)
            values.push_back(static_cast<std::uint16_t>(*symbol));
        else if (const unsigned more = bits.take(8); !values.empty())
            values.insert(values.end(), more, values.back());
    }
    return values;
}

// ---------------------------------------------------------------------------------------------------------------------

// Whether these values are the AC terms of `blocks` blocks, 63 for each block. One value stands for a run of zeros or
// for all the zeros at the end of a block.
bool fill_blocks(const std::vector<std::uint16_t>& values, std::uint64_t blocks) {
    std::size_t at = 0;
    for (; blocks > 0; --blocks) {
        for (unsigned term = 1; term < 64;) {
            if (at == values.size()) return false;
            const std::uint16_t value = values[at++];
            term += value == 0xff00 ? 64 : value >> 8 == 0xff ? value & 0xff : 1;
        }
    }
    return true;
}

bool ac_is_whole(const Head& head, std::span<const std::byte> packed, std::uint64_t blocks) {
    if (head.ac_coding == static_cast<std::uint64_t>(AcCoding::huffman))
        return fill_blocks(unpack_huffman(packed, std::min(head.ac_count, 63 * blocks)), blocks);
    const auto bytes = inflated(packed, std::min(head.ac_count, 63 * blocks) * sizeof(std::uint16_t));
    if (!bytes) return false;
    std::vector<std::uint16_t> values(bytes->size() / sizeof(std::uint16_t));
    std::memcpy(values.data(), bytes->data(), values.size() * sizeof(std::uint16_t));
    return fill_blocks(values, blocks);
}

}  // namespace

bool dwa_is_whole(std::span<const std::byte> chunk, int width, int height, const Imf::ChannelList& channels) {
    Cursor in(chunk);
    Head head{};
    if (!in.read(head)) return false;
    std::optional<std::vector<Rule>> rules = head.version < 2 ? first_rules() : read_rules(in);
    const auto rest = in.take(head.rest_packed);
    const auto ac = in.take(head.ac_packed);
    if (!rules || !rest || !ac) return false;

    const auto blocks_of = [](int texels) { return (static_cast<std::uint64_t>(texels) + 7) / 8; };
    std::uint64_t rest_bytes = 0, runs_bytes = 0, blocks = 0;
    std::vector<Coding> codings;
    for (auto it = channels.begin(); it != channels.end(); ++it) {
        const Imf::PixelType type = it.channel().type;
        const std::uint64_t bytes =
            static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) * (type == Imf::HALF ? 2 : 4);
        codings.push_back(coding_of(*rules, it.name(), type));
        switch (codings.back().scheme) {
            case Scheme::rest: rest_bytes += bytes; break;
            case Scheme::runs: runs_bytes += bytes; break;
            case Scheme::cosine: blocks += blocks_of(width) * blocks_of(height); break;
        }
    }
    // OpenEXR checks that there are as many values of DC and of runs as the chunk claims. For AC and the rest, it
    // relies on the claim.
    if (head.dc_count < blocks || head.runs_unrolled < runs_bytes) return false;
    if (blocks > 0 && (ac->empty() || !(are_decoded_at_once(codings) || ac_is_whole(head, *ac, blocks)))) return false;
    if (rest_bytes == 0) return true;
    const auto stored = inflated(*rest, rest_bytes);
    return stored && stored->size() == rest_bytes;
}

}  // namespace tex
