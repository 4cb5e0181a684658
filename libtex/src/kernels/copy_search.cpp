// SPDX-License-Identifier: Apache-2.0

#include "kernels/copy_search.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#ifndef TEX_COPY_SEARCH_ONCE
#define TEX_COPY_SEARCH_ONCE
namespace tex::inline v1 {
namespace {

// A product of two directions, computed by MulFixedPoint15, is a cosine in units of 1/kCosine. Rounding changes it by
// less than kCosineSlack.
constexpr float kCosine = static_cast<float>(kDirectionUnit) * static_cast<float>(kDirectionUnit) / 32768.0f;
constexpr float kCosineSlack = 16.0f;
// The square of the cosine, likewise.
constexpr float kSquare = kCosine * kCosine / 32768.0f;
constexpr float kSquareSlack = 48.0f;

// What a cosine must exceed for a cost below the bound (for a pair: the weighted sum of the squares of its cosines).
struct CopyLimit {
    std::int16_t fitted;  // if endpoints may change
    std::int16_t whole;   // if all 8 bytes are copied: then the sizes, too, may differ
    std::int16_t size;    // by no more than this, in units of 1/kLengthUnit: 4 means and the length, as two sides of
    std::int16_t square;  // a right angle; its square, of `size` times 2^shift, in units of 32768
    int shift;
};
struct CopyLimits {
    CopyLimit single[2][2];
    CopyLimit pair;
    std::int16_t share[2];  // of x and y in the squares of pairs, in units of 1/32768
};

std::int16_t to_word(float value) {
    return static_cast<std::int16_t>(std::floor(std::min(std::max(value, -32768.0f), 32767.0f)));
}

// `extra` is that of the three types of copy, `room` what the bound leaves for the angles and them.
CopyLimit limit_of(const CopySearch& search, float spread, float rest, float room, const float extra[3], bool is_pair) {
    const float scale = search.scale;
    // The square of the error that is left. Rounding must not dismiss what is below the bound, so this leaves room.
    const auto square = [&](float more) {
        const float length = 1.0001f * (room - more) / scale;
        return room <= more ? -1.0f : length * length - rest + 1e-7f;
    };
    const auto cosine = [&](float error) {
        if (error < 0.0f) return std::int16_t{32767};
        const float least = (spread - error) / std::max(1e-12f, spread) - 1e-5f;
        if (least <= 0.0f) return std::int16_t{-32768};
        return to_word(is_pair ? kSquare * least - kSquareSlack : kCosine * std::sqrt(least) - kCosineSlack);
    };
    const float whole = square(extra[2]);
    constexpr float kSizeSlack = 3.0f;
    constexpr int kSquareRounding = 4;
    const int size = to_word(kLengthUnit * std::sqrt(std::max(0.0f, whole)) + kSizeSlack);
    CopyLimit limit{cosine(square(extra[search.keeps_slope ? 1 : 0])), cosine(whole), 16383, 32767, 0};
    if (size >= 16384) return limit;  // any size
    while (size << (limit.shift + 1) < 16384) ++limit.shift;
    limit.size = static_cast<std::int16_t>(size);
    limit.square = static_cast<std::int16_t>(((size << limit.shift) * (size << limit.shift) >> 15) + kSquareRounding);
    return limit;
}

CopyLimits limits_of(const CopySearch& search, const FoundCopies& found, float price) {
    CopyLimits limits;
    float spreads[2];
    for (int to = 0; to < 2; ++to) {
        spreads[to] = spread_of(*search.values[to]);
        for (int from = 0; from < 2; ++from)
            limits.single[to][from] = limit_of(search, spreads[to], search.rests[to],
                                               found.of[to][from].bound() - price, search.extra[to], false);
    }
    const float both = spreads[0] + spreads[1];
    limits.pair = limit_of(search, both, 0.0f, found.pairs.bound() - price, search.extra[2], true);
    for (int to = 0; to < 2; ++to) limits.share[to] = to_word(32767.0f * (both > 0.0f ? spreads[to] / both : 0.5f));
    return limits;
}

float sum_of_bounds(const FoundCopies& found) {
    return found.of[0][0].bound() + found.of[0][1].bound() + found.of[1][0].bound() + found.of[1][1].bound() +
           found.pairs.bound();
}

// Adds a copy with each of its errors that count.
void add_errors(const CopySearch& search, const std::array<float, 3>& errors, float rest, const float extra[3], int at,
                CheapCopies& cheapest) {
    const float scale = search.scale;
    const float price = search.prices[at];
    for (int q = 2; q >= 0; --q) {
        if (q == 1 && !search.keeps_slope) continue;
        const float square = errors[static_cast<std::size_t>(q)] + rest;
        const float room = 1.0001f * (cheapest.bound() - price - extra[q]);
        if (room <= 0.0f || 0.9999f * scale * scale * square > room * room) continue;
        cheapest.add({scale * std::sqrt(square) + price + extra[q], at, q});
    }
}

// The lists whose limits a block exceeds.
struct CopyBits {
    bool single[2][2];
    bool pair;
};

void add_block_at(const CopySearch& search, int at, const CopyBits& bits, FoundCopies& found) {
    std::array<float, 3> errors[2]{};  // of x from x, and of y from y
    for (int to = 0; to < 2; ++to) {
        for (int from = 1; from >= 0; --from) {
            if (!bits.single[to][from] && !(to == from && bits.pair)) continue;
            const std::array<float, 3> own =
                copy_errors(search.tables[from]->halves[at], *search.values[to], search.keeps_slope);
            if (to == from) errors[to] = own;
            if (bits.single[to][from])
                add_errors(search, own, search.rests[to], search.extra[to], at, found.of[to][from]);
        }
    }
    if (!bits.pair) return;
    for (std::size_t q = 0; q < 3; ++q) errors[0][q] += errors[1][q];
    add_errors(search, errors[0], 0.0f, search.extra[2], at, found.pairs);
}

}  // namespace
}  // namespace tex::inline v1
#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/copy_search.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Words = hn::CappedTag<std::int16_t, 32>;
using WordVector = hn::Vec<Words>;

WordVector times(WordVector part, const std::int16_t* wide) {
    return hn::MulFixedPoint15(part, hn::Load(Words(), wide));
}

// The sum of weighted squares of two cosines, where they are positive.
WordVector pair_square(WordVector x, WordVector y, const CopyLimits& limits) {
    const Words d;
    const WordVector px = hn::Max(x, hn::Zero(d));
    const WordVector py = hn::Max(y, hn::Zero(d));
    return hn::Add(hn::MulFixedPoint15(hn::MulFixedPoint15(px, px), hn::Set(d, limits.share[0])),
                   hn::MulFixedPoint15(hn::MulFixedPoint15(py, py), hn::Set(d, limits.share[1])));
}

using WordMask = hn::Mask<Words>;

std::uint32_t bits_of(WordMask mask) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(Words(), mask, bytes);
    return static_cast<std::uint32_t>(bytes[0]) | static_cast<std::uint32_t>(bytes[1]) << 8 |
           static_cast<std::uint32_t>(bytes[2]) << 16 | static_cast<std::uint32_t>(bytes[3]) << 24;
}

WordMask exceeds(WordVector value, std::int16_t limit) { return hn::Gt(value, hn::Set(Words(), limit)); }

// How much sizes of halves differ from those of the values.
struct SizeGap {
    WordVector mean, length;
};
// 32767 at the most, which the absolute value of -32768 would not be.
WordVector gap_of(WordVector a, WordVector b) { return hn::Max(hn::SaturatedSub(a, b), hn::SaturatedSub(b, a)); }
SizeGap size_gap(const CopyTable& table, int i, CopySize size) {
    const Words d;
    return {gap_of(hn::LoadU(d, table.means + i), hn::Set(d, size.mean)),
            gap_of(hn::LoadU(d, table.lengths + i), hn::Set(d, size.length))};
}

// Their square, as in a limit; what is far beyond its size becomes twice the size.
WordVector gap_square(SizeGap gap, const CopyLimit& limit) {
    const WordVector most = hn::Set(Words(), static_cast<std::int16_t>(2 * limit.size));
    const WordVector mean = hn::ShiftLeftSame(hn::Min(gap.mean, most), limit.shift);
    const WordVector length = hn::ShiftLeftSame(hn::Min(gap.length, most), limit.shift);
    return hn::SaturatedAdd(hn::MulFixedPoint15(mean, mean), hn::MulFixedPoint15(length, length));
}

WordMask is_close(WordVector square, const CopyLimit& limit) {
    return hn::Not(hn::Gt(square, hn::Set(Words(), limit.square)));
}

// Whether a cost may be below the bound. `close` is where sizes are.
WordMask may_gain(WordVector value, WordMask close, const CopyLimit& limit) {
    return hn::Or(exceeds(value, limit.fitted), hn::And(exceeds(value, limit.whole), close));
}

// From the last block on, because near ones cost least: so the bounds are soon low. A block counts only if a cosine is
// large enough and, for copies of all 8 bytes, the sizes agree. The first three parts, with the product of the lengths
// of the others, which is never less than the sum of their products, dismiss most; all parts dismiss most of the rest.
void find_copies_target(const CopySearch& search, FoundCopies& found) {
    const Words d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    HWY_ALIGN std::int16_t wide[2][16][32];
    for (int to = 0; to < 2; ++to) {
        for (int k = 0; k < 16; ++k) hn::Store(hn::Set(d, search.values[to]->direction.parts[k]), d, wide[to][k]);
    }
    const CopyTable& of_x = *search.tables[0];
    const CopyTable& of_y = *search.tables[1];
    const CopySize size_x = search.values[0]->size;
    const CopySize size_y = search.values[1]->size;
    CopyLimits limits{};
    float limits_price = -1.0f, bounds = sum_of_bounds(found);
    for (int i = (search.count - 1) / lanes * lanes; i >= 0; i -= lanes) {
        const int end = std::min(i + lanes, search.count);
        const float price = search.prices[end - 1];
        if (price != limits_price) {
            limits = limits_of(search, found, price);
            limits_price = price;
        }
        WordVector xx = hn::Zero(d), xy = xx, yx = xx, yy = xx;  // of x from x, of x from y ...
        const auto add_part = [&](int k) {
            const WordVector x = hn::LoadU(d, of_x.parts[k] + i);
            const WordVector y = hn::LoadU(d, of_y.parts[k] + i);
            xx = hn::Add(xx, times(x, wide[0][k]));
            yy = hn::Add(yy, times(y, wide[1][k]));
            xy = hn::Add(xy, times(y, wide[0][k]));
            yx = hn::Add(yx, times(x, wide[1][k]));
        };
        for (int k = 0; k < 3; ++k) add_part(k);
        const WordVector rest_x = hn::LoadU(d, of_x.parts[3] + i);
        const WordVector rest_y = hn::LoadU(d, of_y.parts[3] + i);
        const WordVector most_xx = hn::Add(xx, times(rest_x, wide[0][3]));
        const WordVector most_yy = hn::Add(yy, times(rest_y, wide[1][3]));
        const WordVector most_xy = hn::Add(xy, times(rest_y, wide[0][3]));
        const WordVector most_yx = hn::Add(yx, times(rest_x, wide[1][3]));
        const WordVector most_pair = pair_square(most_xx, most_yy, limits);
        auto any = hn::Or(exceeds(most_xx, limits.single[0][0].whole), exceeds(most_yy, limits.single[1][1].whole));
        any = hn::Or(any, exceeds(most_pair, limits.pair.whole));
        if (search.is_across) {
            any = hn::Or(
                any, hn::Or(exceeds(most_xy, limits.single[0][1].whole), exceeds(most_yx, limits.single[1][0].whole)));
        }
        if (hn::AllFalse(d, any)) continue;
        const SizeGap gap_xx = size_gap(of_x, i, size_x);
        const SizeGap gap_yy = size_gap(of_y, i, size_y);
        const WordMask close_xx = is_close(gap_square(gap_xx, limits.single[0][0]), limits.single[0][0]);
        const WordMask close_yy = is_close(gap_square(gap_yy, limits.single[1][1]), limits.single[1][1]);
        const WordMask close_xy =
            is_close(gap_square(size_gap(of_y, i, size_x), limits.single[0][1]), limits.single[0][1]);
        const WordMask close_yx =
            is_close(gap_square(size_gap(of_x, i, size_y), limits.single[1][0]), limits.single[1][0]);
        const WordMask close_pair =
            is_close(hn::SaturatedAdd(gap_square(gap_xx, limits.pair), gap_square(gap_yy, limits.pair)), limits.pair);
        any =
            hn::Or(may_gain(most_xx, close_xx, limits.single[0][0]), may_gain(most_yy, close_yy, limits.single[1][1]));
        any = hn::Or(any, may_gain(most_pair, close_pair, limits.pair));
        if (search.is_across) {
            any = hn::Or(any, hn::Or(may_gain(most_xy, close_xy, limits.single[0][1]),
                                     may_gain(most_yx, close_yx, limits.single[1][0])));
        }
        if (hn::AllFalse(d, any)) continue;
        for (int k = 4; k < 16; ++k) add_part(k);
        const std::uint32_t inside = end - i == 32 ? ~0u : (1u << (end - i)) - 1u;
        const std::uint32_t across = search.is_across ? inside : 0u;
        const std::uint32_t is_xx = inside & bits_of(may_gain(xx, close_xx, limits.single[0][0]));
        const std::uint32_t is_yy = inside & bits_of(may_gain(yy, close_yy, limits.single[1][1]));
        const std::uint32_t is_xy = across & bits_of(may_gain(xy, close_xy, limits.single[0][1]));
        const std::uint32_t is_yx = across & bits_of(may_gain(yx, close_yx, limits.single[1][0]));
        const std::uint32_t pairs = inside & bits_of(may_gain(pair_square(xx, yy, limits), close_pair, limits.pair));
        std::uint32_t all = is_xx | is_yy | is_xy | is_yx | pairs;
        if (all == 0) continue;
        while (all != 0) {
            const int lane = static_cast<int>(std::bit_width(all)) - 1;
            const auto has = [&](std::uint32_t bits) { return (bits >> lane & 1u) != 0; };
            add_block_at(search, i + lane, {{{has(is_xx), has(is_xy)}, {has(is_yx), has(is_yy)}}, has(pairs)}, found);
            all &= ~(1u << lane);
        }
        // Bounds only fall.
        const float new_bounds = sum_of_bounds(found);
        if (new_bounds != bounds) limits_price = -1.0f;
        bounds = new_bounds;
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

HWY_EXPORT(find_copies_target);

void find_copies(const CopySearch& search, FoundCopies& found) {
    if (search.count > 0) HWY_DYNAMIC_DISPATCH(find_copies_target)(search, found);
}

}  // namespace tex::inline v1
#endif
