// SPDX-License-Identifier: Apache-2.0

#include "kernels/copy_search.h"

#include <algorithm>
#include <cmath>

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

// All errors are quadratic forms of four sums: those of the values, of the weights, of their squares and of their
// products. Only the products need a loop over texels.
void score_copies_target(const LineTable& table, int count, const float values[16], float sum, float squares,
                         float* products, float* least) {
    const Floats d;
    const auto zero = hn::Zero(d);
    const auto sixteenth = hn::Set(d, 1.0f / 16.0f);
    const auto v = hn::Set(d, sum);
    const auto spread = hn::Set(d, squares - sum * sum * (1.0f / 16.0f));
    for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(d))) {
        auto even = zero;
        auto odd = zero;
        for (int k = 0; k < 16; k += 2) {
            even = hn::Add(even, hn::Mul(hn::LoadU(d, table.weights[k] + i), hn::Set(d, values[k])));
            odd = hn::Add(odd, hn::Mul(hn::LoadU(d, table.weights[k + 1] + i), hn::Set(d, values[k + 1])));
        }
        const auto wv = hn::Add(even, odd);
        hn::StoreU(wv, d, products + i);
        const auto w = hn::LoadU(d, table.sum + i);
        const auto covariance = hn::Max(zero, hn::Sub(hn::Mul(hn::Set(d, 16.0f), wv), hn::Mul(w, v)));
        const auto explained =
            hn::Mul(hn::Mul(hn::Mul(covariance, covariance), hn::LoadU(d, table.inverse + i)), sixteenth);
        hn::StoreU(hn::Max(zero, hn::Sub(spread, explained)), d, least + i);
    }
}

// Adds one half with its three errors.
void add_copies_at(const CopyCosts& costs, int at, CheapCopies& cheapest) {
    std::array<float, 3> errors = copy_errors(*costs.scores, at);
    if (costs.more != nullptr) {
        const std::array<float, 3> more = copy_errors(*costs.more, at);
        for (std::size_t q = 0; q < 3; ++q) errors[q] += more[q];
    }
    for (int q = 2; q >= 0; --q) {
        const float length = costs.scale * std::sqrt(errors[static_cast<std::size_t>(q)] + costs.rest);
        const float cost = length + costs.prices[at] + costs.extra[q];
        if (cost < cheapest.bound()) cheapest.add({cost, at, q});
    }
}

// From the last half on, because near ones cost least: so the least error of most of the others, at the least price,
// is above the bound.
void add_cheapest_target(const CopyCosts& costs, int count, CheapCopies& cheapest) {
    const Floats d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const auto zero = hn::Zero(d);
    const auto rest = hn::Set(d, costs.rest);
    // Rounding must not dismiss what is below the bound, so both sides leave room for it.
    const auto square_scale = hn::Set(d, 0.9999f * costs.scale * costs.scale);
    const float* const least = costs.scores->least;
    const float* const more = costs.more == nullptr ? nullptr : costs.more->least;
    HWY_ALIGN float below[16];
    for (int i = (count - 1) / lanes * lanes; i >= 0; i -= lanes) {
        auto square = hn::LoadU(d, least + i);
        if (more != nullptr) square = hn::Add(square, hn::LoadU(d, more + i));
        square = hn::Mul(square_scale, hn::Add(square, rest));
        const auto bound = hn::Set(d, 1.00001f * cheapest.bound() - costs.extra[2]);
        const auto room = hn::Max(zero, hn::Sub(bound, hn::LoadU(d, costs.prices + i)));
        const auto is_below = hn::Lt(square, hn::Mul(room, room));
        if (hn::AllFalse(d, is_below)) continue;
        hn::Store(hn::IfThenElseZero(is_below, hn::Set(d, 1.0f)), d, below);
        for (int k = std::min(lanes, count - i) - 1; k >= 0; --k) {
            if (below[k] != 0.0f) add_copies_at(costs, i + k, cheapest);
        }
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

HWY_EXPORT(score_copies_target);
HWY_EXPORT(add_cheapest_target);
HWY_EXPORT(block_chords_target);
HWY_EXPORT(chord_sums_target);

CopyScores score_copies(const LineTable& table, int count, const float values[16], bool keeps_slope, float* products,
                        float* least) {
    CopyScores scores{table, keeps_slope, 0.0f, 0.0f, products, least};
    for (int k = 0; k < 16; ++k) {
        scores.sum += values[k];
        scores.squares += values[k] * values[k];
    }
    HWY_DYNAMIC_DISPATCH(score_copies_target)(table, count, values, scores.sum, scores.squares, products, least);
    return scores;
}

std::array<float, 3> copy_errors(const CopyScores& scores, int at) {
    const float v = scores.sum;
    const float vv = scores.squares;
    const float wv = scores.products[at];
    const float w = scores.table.sum[at];
    const float ww = scores.table.squares[at];
    const float offset = scores.table.offset[at];
    const float slope = scores.table.slope[at];
    const float least = scores.least[at];
    // Relative to the offset of the half.
    const float moved = wv - offset * w;
    const float flat = vv - offset * (2.0f * v - 16.0f * offset);
    float one = 0.0f;
    if (scores.keeps_slope) {
        const float both = wv - w * v * (1.0f / 16.0f);
        const float own = ww - w * w * (1.0f / 16.0f);
        one = vv - v * v * (1.0f / 16.0f) - slope * (2.0f * both - slope * own);
    } else {
        const float part = std::max(0.0f, moved);
        one = flat - part * part / std::max(ww, 1e-6f);
    }
    const float none = flat - slope * (2.0f * moved - slope * ww);
    return {least, std::max(least, one), std::max(least, none)};
}

void add_cheapest(const CopyCosts& costs, int count, CheapCopies& cheapest) {
    HWY_DYNAMIC_DISPATCH(add_cheapest_target)(costs, count, cheapest);
}

void block_chords(const float* const normals[3], const float x[16], const float y[16], float chords[16]) {
    HWY_DYNAMIC_DISPATCH(block_chords_target)(normals, x, y, chords);
}

void chord_sums(const ChordTexels& texels, const float* values, int stride, int count, float* sums) {
    HWY_DYNAMIC_DISPATCH(chord_sums_target)(texels, values, stride, count, sums);
}

}  // namespace tex
#endif
