// SPDX-License-Identifier: Apache-2.0

#include "blocks/astc_endpoints.h"

#include <algorithm>

namespace tex::inline v1 {
namespace {

struct Colors {
    int r, g, b, a;
};

AstcEndpoints between(const Colors& e0, const Colors& e1) {
    const auto code = [](int c) { return std::clamp(c, 0, 255); };
    return {{{code(e0.r), code(e0.g), code(e0.b), code(e0.a)}, {code(e1.r), code(e1.g), code(e1.b), code(e1.a)}}};
}

Colors blue_contracted(const Colors& c) { return {(c.r + c.b) >> 1, (c.g + c.b) >> 1, c.b, c.a}; }

// A base of 8 bits, the highest of which stands in the value of the offset; and an offset from -32 to 31.
struct OffsetPair {
    int base, offset;
};
OffsetPair offset_pair(int base, int offset) {
    const int six = offset >> 1 & 0x3f;
    return {base >> 1 | (offset & 0x80), six >= 0x20 ? six - 0x40 : six};
}

AstcEndpoints by_sum(const Colors& e0, const Colors& e1) {
    if (e1.r + e1.g + e1.b >= e0.r + e0.g + e0.b) return between(e0, e1);
    return between(blue_contracted(e1), blue_contracted(e0));
}

AstcEndpoints by_offsets(const OffsetPair pairs[4]) {
    const auto [r, g, b, a] = Colors{pairs[0].base, pairs[1].base, pairs[2].base, pairs[3].base};
    const Colors e0{r, g, b, a};
    const Colors e1{r + pairs[0].offset, g + pairs[1].offset, b + pairs[2].offset, a + pairs[3].offset};
    if (pairs[0].offset + pairs[1].offset + pairs[2].offset >= 0) return between(e0, e1);
    return between(blue_contracted(e1), blue_contracted(e0));
}

}  // namespace

AstcEndpoints astc_endpoints(int mode, const std::uint8_t* v) {
    switch (mode) {
        case kAstcLuminance: return between({v[0], v[0], v[0], 255}, {v[1], v[1], v[1], 255});
        case kAstcLuminanceOffset: {
            const int l0 = v[0] >> 2 | (v[1] & 0xc0), l1 = l0 + (v[1] & 0x3f);
            return between({l0, l0, l0, 255}, {l1, l1, l1, 255});
        }
        case kAstcLuminanceAlpha: return between({v[0], v[0], v[0], v[2]}, {v[1], v[1], v[1], v[3]});
        case kAstcLuminanceAlphaOffset: {
            const OffsetPair l = offset_pair(v[0], v[1]), a = offset_pair(v[2], v[3]);
            const int l1 = l.base + l.offset;
            return between({l.base, l.base, l.base, a.base}, {l1, l1, l1, a.base + a.offset});
        }
        case 6:
        case 10: {
            const int a0 = mode == 10 ? v[4] : 255, a1 = mode == 10 ? v[5] : 255;
            const auto scaled = [&](int c) { return (c * v[3]) >> 8; };
            return between({scaled(v[0]), scaled(v[1]), scaled(v[2]), a0}, {v[0], v[1], v[2], a1});
        }
        case 8: return by_sum({v[0], v[2], v[4], 255}, {v[1], v[3], v[5], 255});
        case 12: return by_sum({v[0], v[2], v[4], v[6]}, {v[1], v[3], v[5], v[7]});
        case 9:
        case 13: {
            OffsetPair pairs[4] = {offset_pair(v[0], v[1]), offset_pair(v[2], v[3]), offset_pair(v[4], v[5]), {255, 0}};
            if (mode == 13) pairs[3] = offset_pair(v[6], v[7]);
            return by_offsets(pairs);
        }
        default: return between({255, 0, 255, 255}, {255, 0, 255, 255});
    }
}

}  // namespace tex::inline v1
