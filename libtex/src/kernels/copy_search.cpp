// SPDX-License-Identifier: Apache-2.0

#include "kernels/copy_search.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#ifndef TEX_COPY_SEARCH_ONCE
#define TEX_COPY_SEARCH_ONCE
namespace tex {
namespace {

// A product of two directions, computed by MulFixedPoint15, is a cosine in units of 1/kCosine. Rounding changes it by
// less than kCosineSlack.
constexpr float kCosine = static_cast<float>(kDirectionUnit) * static_cast<float>(kDirectionUnit) / 32768.0f;
constexpr float kCosineSlack = 16.0f;
// The same of its square.
constexpr float kSquare = kCosine * kCosine / 32768.0f;
constexpr float kSquareSlack = 48.0f;

// What cosines must exceed, and the squares of those of pairs.
struct CopyLimits {
    std::int16_t single[2][2];
    std::int16_t pair;
    std::int16_t share[2];  // of x and y in the squares of pairs, in units of 1/32768
};

float spread_of(const CopyValues& values) {
    return std::max(0.0f, values.squares - values.sum * values.sum * (1.0f / 16.0f));
}

// The square of the cosine from which on costs may be below the bound: those of the least error, at least extra cost.
float least_square(float spread, float rest, float room, float scale) {
    if (room <= 0.0f) return 2.0f;
    // Rounding must not dismiss what is below the bound, so this leaves room for it.
    const float length = 1.0001f * room / scale;
    return (spread + rest - length * length) / std::max(1e-12f, spread) - 1e-5f;
}

std::int16_t limit_of(float value) {
    return static_cast<std::int16_t>(std::floor(std::min(std::max(value, -32768.0f), 32767.0f)));
}

CopyLimits limits_of(const CopySearch& search, const FoundCopies& found, float price) {
    CopyLimits limits;
    float spreads[2];
    for (int to = 0; to < 2; ++to) {
        spreads[to] = spread_of(*search.values[to]);
        for (int from = 0; from < 2; ++from) {
            const float room = found.of[to][from].bound() - price - search.extra[to][2];
            const float square = least_square(spreads[to], search.rests[to], room, search.scale);
            limits.single[to][from] = limit_of(square <= 0.0f ? -32768.0f : kCosine * std::sqrt(square) - kCosineSlack);
        }
    }
    const float both = spreads[0] + spreads[1];
    const float room = found.pairs.bound() - price - search.extra[2][2];
    const float square = least_square(both, 0.0f, room, search.scale);
    limits.pair = limit_of(square <= 0.0f ? -32768.0f : kSquare * square - kSquareSlack);
    for (int to = 0; to < 2; ++to) limits.share[to] = limit_of(32767.0f * (both > 0.0f ? spreads[to] / both : 0.5f));
    return limits;
}

// Adds a copy with each of its errors.
void add_errors(const std::array<float, 3>& errors, float rest, float scale, float price, const float extra[3], int at,
                CheapCopies& cheapest) {
    for (int q = 2; q >= 0; --q) {
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
    const float price = search.prices[at];
    for (int to = 0; to < 2; ++to) {
        for (int from = 1; from >= 0; --from) {
            if (!bits.single[to][from] && !(to == from && bits.pair)) continue;
            const std::array<float, 3> own =
                copy_errors(search.tables[from]->halves[at], *search.values[to], search.keeps_slope);
            if (to == from) errors[to] = own;
            if (bits.single[to][from])
                add_errors(own, search.rests[to], search.scale, price, search.extra[to], at, found.of[to][from]);
        }
    }
    if (!bits.pair) return;
    for (std::size_t q = 0; q < 3; ++q) errors[0][q] += errors[1][q];
    add_errors(errors[0], 0.0f, search.scale, price, search.extra[2], at, found.pairs);
}

}  // namespace
}  // namespace tex
#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/copy_search.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tex {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, 16>;
using Vector = hn::Vec<Floats>;

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

std::uint32_t bits_of(WordVector value, std::int16_t limit) {
    const Words d;
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, hn::Gt(value, hn::Set(d, limit)), bytes);
    return static_cast<std::uint32_t>(bytes[0]) | static_cast<std::uint32_t>(bytes[1]) << 8 |
           static_cast<std::uint32_t>(bytes[2]) << 16 | static_cast<std::uint32_t>(bytes[3]) << 24;
}

// From the last block on, because near ones cost least: so the bounds are soon low. A block counts only if a cosine is
// large enough. The first three parts, with the product of the lengths of the others, which is never less than the sum
// of their products, dismiss most; all parts dismiss most of the rest.
void find_copies_target(const CopySearch& search, FoundCopies& found) {
    const Words d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    HWY_ALIGN std::int16_t wide[2][16][32];
    for (int to = 0; to < 2; ++to) {
        for (int k = 0; k < 16; ++k) hn::Store(hn::Set(d, search.values[to]->direction.parts[k]), d, wide[to][k]);
    }
    CopyLimits limits{};
    float limits_price = -1.0f;
    for (int i = (search.count - 1) / lanes * lanes; i >= 0; i -= lanes) {
        const int end = std::min(i + lanes, search.count);
        const float price = search.prices[end - 1];
        if (price != limits_price) {
            limits = limits_of(search, found, price);
            limits_price = price;
        }
        WordVector xx = hn::Zero(d), xy = xx, yx = xx, yy = xx;  // of x from x, of x from y ...
        const auto add_part = [&](int k) {
            const WordVector x = hn::LoadU(d, search.tables[0]->parts[k] + i);
            const WordVector y = hn::LoadU(d, search.tables[1]->parts[k] + i);
            xx = hn::Add(xx, times(x, wide[0][k]));
            yy = hn::Add(yy, times(y, wide[1][k]));
            xy = hn::Add(xy, times(y, wide[0][k]));
            yx = hn::Add(yx, times(x, wide[1][k]));
        };
        for (int k = 0; k < 3; ++k) add_part(k);
        const WordVector rest_x = hn::LoadU(d, search.tables[0]->parts[3] + i);
        const WordVector rest_y = hn::LoadU(d, search.tables[1]->parts[3] + i);
        const WordVector most_xx = hn::Add(xx, times(rest_x, wide[0][3]));
        const WordVector most_yy = hn::Add(yy, times(rest_y, wide[1][3]));
        const WordVector most_xy = hn::Add(xy, times(rest_y, wide[0][3]));
        const WordVector most_yx = hn::Add(yx, times(rest_x, wide[1][3]));
        auto any =
            hn::Or(hn::Gt(most_xx, hn::Set(d, limits.single[0][0])), hn::Gt(most_yy, hn::Set(d, limits.single[1][1])));
        any = hn::Or(any, hn::Gt(pair_square(most_xx, most_yy, limits), hn::Set(d, limits.pair)));
        if (search.is_across) {
            any = hn::Or(any, hn::Or(hn::Gt(most_xy, hn::Set(d, limits.single[0][1])),
                                     hn::Gt(most_yx, hn::Set(d, limits.single[1][0]))));
        }
        if (hn::AllFalse(d, any)) continue;
        for (int k = 4; k < 16; ++k) add_part(k);
        const std::uint32_t inside = end - i == 32 ? ~0u : (1u << (end - i)) - 1u;
        const std::uint32_t across = search.is_across ? inside : 0u;
        const std::uint32_t of_xx = inside & bits_of(xx, limits.single[0][0]);
        const std::uint32_t of_yy = inside & bits_of(yy, limits.single[1][1]);
        const std::uint32_t of_xy = across & bits_of(xy, limits.single[0][1]);
        const std::uint32_t of_yx = across & bits_of(yx, limits.single[1][0]);
        const std::uint32_t pairs = inside & bits_of(pair_square(xx, yy, limits), limits.pair);
        std::uint32_t all = of_xx | of_yy | of_xy | of_yx | pairs;
        if (all == 0) continue;
        while (all != 0) {
            const int lane = std::bit_width(all) - 1;
            const auto has = [&](std::uint32_t bits) { return (bits >> lane & 1u) != 0; };
            add_block_at(search, i + lane, {{{has(of_xx), has(of_xy)}, {has(of_yx), has(of_yy)}}, has(pairs)}, found);
            all &= ~(1u << lane);
        }
        limits_price = -1.0f;
    }
}

// What makes decoded components unit: the inverse of their length where that is above 1, where z is 0, and 1 elsewhere.
// Few blocks have such texels.
Vector rim_factor(Vector square) {
    const Floats d;
    const auto one = hn::Set(d, 1.0f);
    if (hn::AllTrue(d, hn::Le(square, one))) return one;
    return hn::Div(one, hn::Sqrt(hn::Max(one, square)));
}

void block_chords_target(const float* const normals[3], const float x[16], const float y[16], float chords[16]) {
    const Floats d;
    const auto one = hn::Set(d, 1.0f);
    for (int i = 0; i < 16; i += static_cast<int>(hn::Lanes(d))) {
        const auto mx = hn::LoadU(d, x + i);
        const auto my = hn::LoadU(d, y + i);
        const auto flat = hn::Add(hn::Mul(mx, mx), hn::Mul(my, my));
        const auto factor = rim_factor(flat);
        const auto mz = hn::Sqrt(hn::Sub(one, hn::Min(one, flat)));
        const auto dx = hn::Sub(hn::LoadU(d, normals[0] + i), hn::Mul(mx, factor));
        const auto dy = hn::Sub(hn::LoadU(d, normals[1] + i), hn::Mul(my, factor));
        const auto dz = hn::Sub(hn::LoadU(d, normals[2] + i), mz);
        const auto square = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
        hn::StoreU(hn::Sqrt(square), d, chords + i);
    }
}

void chord_sums_target(const ChordTexels& texels, const float* values, int stride, int count, float* sums) {
    const Floats d;
    const auto one = hn::Set(d, 1.0f);
    for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(d))) {
        auto sum = hn::Zero(d);
        auto allowed = hn::Eq(one, one);
        for (int k = 0; k < 16; ++k) {
            const auto value = hn::LoadU(d, values + static_cast<std::ptrdiff_t>(k) * stride + i);
            const auto decoded = hn::Set(d, texels.decoded[k]);
            const auto flat = hn::Add(hn::Mul(value, value), hn::Mul(decoded, decoded));
            const auto factor = rim_factor(flat);
            const auto dv = hn::Sub(hn::Set(d, texels.own[k]), hn::Mul(value, factor));
            const auto dw = hn::Sub(hn::Set(d, texels.other[k]), hn::Mul(decoded, factor));
            const auto dz = hn::Sub(hn::Set(d, texels.z[k]), hn::Sqrt(hn::Sub(one, hn::Min(one, flat))));
            const auto square = hn::Add(hn::Add(hn::Mul(dv, dv), hn::Mul(dw, dw)), hn::Mul(dz, dz));
            const auto chord = hn::Sqrt(square);
            allowed = hn::And(allowed, hn::Le(chord, hn::Set(d, texels.most[k])));
            sum = hn::Add(sum, hn::Mul(chord, hn::Set(d, texels.inside[k])));
        }
        hn::StoreU(hn::IfThenElse(allowed, sum, hn::Set(d, kTooLong)), d, sums + i);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace tex
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex {

HWY_EXPORT(find_copies_target);
HWY_EXPORT(block_chords_target);
HWY_EXPORT(chord_sums_target);

CopyHalf copy_half(const HalfShape& shape) {
    CopyHalf half{shape, 0.0f, 0.0f, 0.0f};
    for (const float weight : shape.weights) {
        half.sum += weight;
        half.squares += weight * weight;
    }
    const float variance = 16.0f * half.squares - half.sum * half.sum;
    half.inverse = variance > 1e-3f ? 1.0f / variance : 0.0f;
    return half;
}

CopyDirection copy_direction(const float values[16]) {
    // cos(pi/8) / sqrt(2), sin(pi/8) / sqrt(2)
    constexpr float kC = 0.6532814824381883f, kS = 0.2705980500730985f;
    constexpr float kBasis[4][4] = {
        {0.5f, 0.5f, 0.5f, 0.5f}, {kC, kS, -kS, -kC}, {0.5f, -0.5f, -0.5f, 0.5f}, {kS, -kC, kC, -kS}};
    // Each part's row and column of frequencies.
    constexpr int kOrder[16] = {1, 4, 5, 0, 2, 8, 6, 9, 3, 12, 7, 13, 10, 11, 14, 15};
    float rows[16], cosines[16];
    for (int j = 0; j < 4; ++j) {
        for (int f = 0; f < 4; ++f) {
            const float* const v = values + std::ptrdiff_t{4} * j;
            rows[4 * j + f] = v[0] * kBasis[f][0] + v[1] * kBasis[f][1] + v[2] * kBasis[f][2] + v[3] * kBasis[f][3];
        }
    }
    for (int g = 0; g < 4; ++g) {
        for (int f = 0; f < 4; ++f)
            cosines[4 * g + f] = rows[f] * kBasis[g][0] + rows[4 + f] * kBasis[g][1] + rows[8 + f] * kBasis[g][2] +
                                 rows[12 + f] * kBasis[g][3];
    }
    float low = 0.0f, high = 0.0f;  // squares
    for (int k = 0; k < 16; ++k) {
        if (k != 3) (k < 3 ? low : high) += cosines[kOrder[k]] * cosines[kOrder[k]];
    }
    CopyDirection direction{};
    if (low + high < 1e-9f) return direction;
    const float scale = static_cast<float>(kDirectionUnit) / std::sqrt(low + high);
    for (int k = 0; k < 16; ++k)
        direction.parts[k] = static_cast<std::int16_t>(std::floor(scale * cosines[kOrder[k]] + 0.5f));
    direction.parts[3] = static_cast<std::int16_t>(std::floor(scale * std::sqrt(high)) + 2.0f);
    return direction;
}

CopyValues copy_values(const float values[16]) {
    CopyValues found{{}, 0.0f, 0.0f, copy_direction(values)};
    for (int k = 0; k < 16; ++k) {
        found.values[k] = values[k];
        found.sum += values[k];
        found.squares += values[k] * values[k];
    }
    return found;
}

std::array<float, 3> copy_errors(const CopyHalf& half, const CopyValues& values, bool keeps_slope) {
    // The errors of what is not a line must not look small.
    if (!half.shape.is_line) return {1e12f, 1e12f, 1e12f};
    float sums[4] = {};
    for (int k = 0; k < 16; k += 4) {
        for (int c = 0; c < 4; ++c) sums[c] += half.shape.weights[k + c] * values.values[k + c];
    }
    const float wv = (sums[0] + sums[2]) + (sums[1] + sums[3]);
    const float v = values.sum;
    const float vv = values.squares;
    const float w = half.sum;
    const float ww = half.squares;
    const float offset = half.shape.line.offset;
    const float slope = half.shape.line.slope;
    const float spread = vv - v * v * (1.0f / 16.0f);
    const float covariance = std::max(0.0f, 16.0f * wv - w * v);
    const float least = std::max(0.0f, spread - covariance * covariance * half.inverse * (1.0f / 16.0f));
    // Relative to the offset of the half.
    const float moved = wv - offset * w;
    const float flat = vv - offset * (2.0f * v - 16.0f * offset);
    float one = 0.0f;
    if (keeps_slope) {
        const float both = wv - w * v * (1.0f / 16.0f);
        const float own = ww - w * w * (1.0f / 16.0f);
        one = spread - slope * (2.0f * both - slope * own);
    } else {
        const float part = std::max(0.0f, moved);
        one = flat - part * part / std::max(ww, 1e-6f);
    }
    const float none = flat - slope * (2.0f * moved - slope * ww);
    return {least, std::max(least, one), std::max(least, none)};
}

void find_copies(const CopySearch& search, FoundCopies& found) {
    if (search.count > 0) HWY_DYNAMIC_DISPATCH(find_copies_target)(search, found);
}

void block_chords(const float* const normals[3], const float x[16], const float y[16], float chords[16]) {
    HWY_DYNAMIC_DISPATCH(block_chords_target)(normals, x, y, chords);
}

void chord_sums(const ChordTexels& texels, const float* values, int stride, int count, float* sums) {
    HWY_DYNAMIC_DISPATCH(chord_sums_target)(texels, values, stride, count, sums);
}

}  // namespace tex
#endif
