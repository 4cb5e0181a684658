// SPDX-License-Identifier: Apache-2.0

#include "blocks/astc_ise.h"

#include <algorithm>

namespace tex::inline v1 {
namespace {

// The parts of the 8 bits that five trits share, and of the 7 bits of three quints, beside each value.
struct Part {
    int at, count;
};
constexpr Part kTritParts[5] = {{0, 2}, {2, 2}, {4, 1}, {5, 2}, {7, 1}};
constexpr Part kQuintParts[3] = {{0, 3}, {3, 2}, {5, 2}};

constexpr unsigned bits_of(unsigned from, int high, int low) { return from >> low & ((2u << (high - low)) - 1); }

struct Uppers {
    std::uint8_t value[5] = {};
};

// The specification's tables of trits and quints, as its formulas.
constexpr Uppers trits_of(unsigned t) {
    unsigned c = 0, t0 = 0, t1 = 0, t2 = 0, t3 = 0, t4 = 0;
    if (bits_of(t, 4, 2) == 7) {
        c = bits_of(t, 7, 5) << 2 | bits_of(t, 1, 0);
        t3 = t4 = 2;
    } else {
        c = bits_of(t, 4, 0);
        const bool both = bits_of(t, 6, 5) == 3;
        t4 = both ? 2 : t >> 7;
        t3 = both ? t >> 7 : bits_of(t, 6, 5);
    }
    if (bits_of(c, 1, 0) == 3) {
        t2 = 2;
        t1 = c >> 4;
        t0 = bits_of(c, 3, 3) << 1 | (bits_of(c, 2, 2) & ~bits_of(c, 3, 3));
    } else if (bits_of(c, 3, 2) == 3) {
        t2 = t1 = 2;
        t0 = bits_of(c, 1, 0);
    } else {
        t2 = c >> 4;
        t1 = bits_of(c, 3, 2);
        t0 = bits_of(c, 1, 1) << 1 | (bits_of(c, 0, 0) & ~bits_of(c, 1, 1));
    }
    Uppers uppers;
    const unsigned all[5] = {t0, t1, t2, t3, t4};
    for (int k = 0; k < 5; ++k) uppers.value[k] = static_cast<std::uint8_t>(all[k]);
    return uppers;
}

constexpr Uppers quints_of(unsigned q) {
    unsigned q0 = 0, q1 = 0, q2 = 0;
    if (bits_of(q, 2, 1) == 3 && bits_of(q, 6, 5) == 0) {
        const unsigned low = q & 1;
        q2 = low << 2 | (bits_of(q, 4, 4) & ~low) << 1 | (bits_of(q, 3, 3) & ~low);
        q0 = q1 = 4;
    } else {
        unsigned c = 0;
        if (bits_of(q, 2, 1) == 3) {
            q2 = 4;
            c = bits_of(q, 4, 3) << 3 | (~bits_of(q, 6, 5) & 3) << 1 | (q & 1);
        } else {
            q2 = bits_of(q, 6, 5);
            c = bits_of(q, 4, 0);
        }
        const bool five = bits_of(c, 2, 0) == 5;
        q1 = five ? 4 : bits_of(c, 4, 3);
        q0 = five ? bits_of(c, 4, 3) : bits_of(c, 2, 0);
    }
    Uppers uppers;
    const unsigned all[3] = {q0, q1, q2};
    for (int k = 0; k < 3; ++k) uppers.value[k] = static_cast<std::uint8_t>(all[k]);
    return uppers;
}

struct Sharing {
    Uppers trits[256], quints[128];
    std::uint8_t of_trits[243] = {}, of_quints[125] = {};  // the least bits that mean five trits, or three quints
};

constexpr Sharing make_sharing() {
    Sharing s;
    for (unsigned t = 256; t-- > 0;) {
        s.trits[t] = trits_of(t);
        const auto& v = s.trits[t].value;
        s.of_trits[v[0] + 3 * (v[1] + 3 * (v[2] + 3 * (v[3] + 3 * v[4])))] = static_cast<std::uint8_t>(t);
    }
    for (unsigned q = 128; q-- > 0;) {
        s.quints[q] = quints_of(q);
        const auto& v = s.quints[q].value;
        s.of_quints[v[0] + 5 * (v[1] + 5 * v[2])] = static_cast<std::uint8_t>(q);
    }
    return s;
}

constexpr Sharing kSharing = make_sharing();

// The lower bits of a value (a lowest, then b, c ...) put where the pattern names them, as the specification does.
constexpr unsigned spread(const char* pattern, unsigned lower) {
    unsigned value = 0;
    for (; *pattern != '\0'; ++pattern) value = value << 1 | (*pattern == '0' ? 0 : lower >> (*pattern - 'a') & 1);
    return value;
}

struct Rule {
    int levels;
    const char* b;
    unsigned c;
};
constexpr Rule kColorRules[] = {{6, "000000000", 204}, {10, "000000000", 113}, {12, "b000b0bb0", 93},
                                {20, "b0000bb00", 54}, {24, "cb000cbcb", 44},  {40, "cb0000cbc", 26},
                                {48, "dcb000dcb", 22}, {80, "dcb0000dc", 13},  {96, "edcb000ed", 11},
                                {160, "edcb0000e", 6}, {192, "fedcb000f", 5}};
constexpr Rule kWeightRules[] = {
    {6, "0000000", 50}, {10, "0000000", 28}, {12, "b000b0b", 23}, {20, "b0000b0", 13}, {24, "cb000cb", 11}};

// `width` is the number of bits of the meaning; the rules compute one more.
constexpr unsigned by_rule(const Rule& rule, int width, AstcRange range, unsigned stored) {
    const unsigned all = (2u << width) - 1;
    const unsigned a = (stored & 1) != 0 ? all : 0;
    const unsigned lower = stored & ((1u << range.bits) - 1);
    const unsigned t = ((stored >> range.bits) * rule.c + spread(rule.b, lower)) ^ a;
    return (a & (1u << (width - 1))) | t >> 2;
}

constexpr unsigned repeated(unsigned stored, int bits, int width) {
    unsigned value = 0;
    int at = width;
    while (at > 0) {
        at -= bits;
        value |= at >= 0 ? stored << at : stored >> -at;
    }
    return value;
}

constexpr unsigned color_of(AstcRange range, unsigned stored) {
    for (const Rule& rule : kColorRules) {
        if (rule.levels == range.levels) return by_rule(rule, 8, range, stored);
    }
    return range.upper == 1 ? repeated(stored, range.bits, 8) : 0;
}

constexpr unsigned weight_of(AstcRange range, unsigned stored) {
    unsigned weight = 0;
    if (range.levels == 3) weight = stored == 2 ? 63 : 32 * stored;
    if (range.levels == 5) weight = stored < 3 ? 16 * stored : 15 + 16 * (stored - 1);
    if (range.upper == 1) weight = repeated(stored, range.bits, 6);
    for (const Rule& rule : kWeightRules) {
        if (rule.levels == range.levels) weight = by_rule(rule, 6, range, stored);
    }
    return weight > 32 ? weight + 1 : weight;
}

constexpr AstcMeanings make_meanings() {
    AstcMeanings m;
    for (int r = 0; r < kAstcRanges; ++r) {
        const AstcRange range = kAstcRangeTable[r];
        for (unsigned v = 0; v < static_cast<unsigned>(range.levels); ++v) {
            if (r >= kAstcLeastColorRange) m.color[r][v] = static_cast<std::uint8_t>(color_of(range, v));
            if (r < kAstcWeightRanges) m.weight[r][v] = static_cast<std::uint8_t>(weight_of(range, v));
        }
    }
    return m;
}

}  // namespace

constexpr AstcMeanings kAstcMeanings = make_meanings();

namespace {

std::uint64_t reversed_64(std::uint64_t v) {
    v = (v >> 1 & 0x5555555555555555u) | (v & 0x5555555555555555u) << 1;
    v = (v >> 2 & 0x3333333333333333u) | (v & 0x3333333333333333u) << 2;
    v = (v >> 4 & 0x0f0f0f0f0f0f0f0fu) | (v & 0x0f0f0f0f0f0f0f0fu) << 4;
    v = (v >> 8 & 0x00ff00ff00ff00ffu) | (v & 0x00ff00ff00ff00ffu) << 8;
    v = (v >> 16 & 0x0000ffff0000ffffu) | (v & 0x0000ffff0000ffffu) << 16;
    return v >> 32 | v << 32;
}

}  // namespace

AstcBits AstcBits::reversed() const { return {reversed_64(high), reversed_64(low)}; }

AstcBits read_astc_bits(const std::byte* block) {
    AstcBits bits;
    for (int k = 7; k >= 0; --k) {
        bits.low = bits.low << 8 | std::to_integer<std::uint64_t>(block[k]);
        bits.high = bits.high << 8 | std::to_integer<std::uint64_t>(block[8 + k]);
    }
    return bits;
}

void write_astc_bits(const AstcBits& bits, std::byte* block) {
    for (int k = 0; k < 8; ++k) {
        block[k] = static_cast<std::byte>(bits.low >> (8 * k));
        block[8 + k] = static_cast<std::byte>(bits.high >> (8 * k));
    }
}

int astc_range_within(int count, int bits) {
    int range = kAstcRanges - 1;
    while (range >= 0 && astc_ise_bits(range, count) > bits) --range;
    return range;
}

void read_astc_ise(const AstcBits& bits, int at, int range, int count, std::uint8_t* values) {
    const AstcRange r = kAstcRangeTable[range];
    if (r.upper == 1) {
        for (int k = 0; k < count; ++k, at += r.bits) values[k] = static_cast<std::uint8_t>(bits.at(at, r.bits));
        return;
    }
    const Part* const parts = r.upper == 3 ? kTritParts : kQuintParts;
    const int group = r.upper == 3 ? 5 : 3;
    for (int first = 0; first < count; first += group) {
        const int n = count - first < group ? count - first : group;
        unsigned shared = 0;
        for (int k = 0; k < n; ++k) {
            const unsigned both = bits.at(at, r.bits + parts[k].count);
            values[first + k] = static_cast<std::uint8_t>(both & ((1u << r.bits) - 1));
            shared |= both >> r.bits << parts[k].at;
            at += r.bits + parts[k].count;
        }
        const Uppers& uppers = r.upper == 3 ? kSharing.trits[shared] : kSharing.quints[shared];
        for (int k = 0; k < n; ++k) {
            values[first + k] = static_cast<std::uint8_t>(values[first + k] | uppers.value[k] << r.bits);
        }
    }
}

namespace {

// Values whose upper parts have kUpper values, kGroup of which share bits.
template <int kGroup, unsigned kUpper>
void write_shared(AstcBits& bits, int at, int lower_bits, int count, const std::uint8_t* values) {
    const Part* const parts = kUpper == 3 ? kTritParts : kQuintParts;
    const std::uint8_t* const shared_by = kUpper == 3 ? kSharing.of_trits : kSharing.of_quints;
    std::uint8_t last[kGroup] = {};
    for (; count > 0; count -= kGroup, values += kGroup) {
        const int n = count < kGroup ? count : kGroup;
        if (n < kGroup) values = std::copy_n(values, n, last) - n;
        unsigned number = 0;
        for (int k = kGroup; k-- > 0;) number = number * kUpper + (values[k] >> lower_bits);
        const std::uint64_t shared = shared_by[number];
        std::uint64_t all = 0;
        for (int k = 0; k < kGroup; ++k) {
            const std::uint64_t lower = values[k] & ((1u << lower_bits) - 1);
            const std::uint64_t upper = shared & (((1u << parts[k].count) - 1) << parts[k].at);
            all |= lower << (k * lower_bits + parts[k].at) | upper << ((k + 1) * lower_bits);
        }
        const int used = n * lower_bits + parts[n - 1].at + parts[n - 1].count;
        bits.put(at, used, all);
        at += used;
    }
}

}  // namespace

void write_astc_ise(AstcBits& bits, int at, int range, int count, const std::uint8_t* values) {
    const AstcRange r = kAstcRangeTable[range];
    if (r.upper == 3) return write_shared<5, 3>(bits, at, r.bits, count, values);
    if (r.upper == 5) return write_shared<3, 5>(bits, at, r.bits, count, values);
    for (; count >= 8; count -= 8, values += 8, at += 8 * r.bits) {
        std::uint64_t all = 0;
        for (int k = 8; k-- > 0;) all = all << r.bits | values[k];
        bits.put(at, 8 * r.bits, all);
    }
    for (int k = 0; k < count; ++k) bits.put(at + k * r.bits, r.bits, values[k]);
}

}  // namespace tex::inline v1
