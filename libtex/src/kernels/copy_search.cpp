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

// The sums over the 16 values that do not depend on the half.
struct ValueSums {
    float sum = 0.0f, squares = 0.0f;
    explicit ValueSums(const float values[16]) {
        for (int k = 0; k < 16; ++k) {
            sum += values[k];
            squares += values[k] * values[k];
        }
    }
};

// All errors are quadratic forms of four sums: those of the values, of the weights, of their squares and of their
// products. Only the products need a loop over texels.
void copy_errors_target(const LineTable& table, int count, const float values[16], bool keeps_slope,
                        float* const errors[3]) {
    const Floats d;
    const ValueSums of(values);
    const auto zero = hn::Zero(d);
    const auto sixteenth = hn::Set(d, 1.0f / 16.0f);
    const auto two = hn::Set(d, 2.0f);
    const auto v = hn::Set(d, of.sum);
    const auto vv = hn::Set(d, of.squares);
    const auto spread = hn::Sub(vv, hn::Mul(hn::Mul(v, v), sixteenth));
    for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(d))) {
        auto wv = zero;
        for (int k = 0; k < 16; ++k)
            wv = hn::Add(wv, hn::Mul(hn::LoadU(d, table.weights[k] + i), hn::Set(d, values[k])));
        const auto w = hn::LoadU(d, table.sum + i);
        const auto ww = hn::LoadU(d, table.squares + i);
        const auto offset = hn::LoadU(d, table.offset + i);
        const auto slope = hn::LoadU(d, table.slope + i);

        const auto covariance = hn::Max(zero, hn::Sub(hn::Mul(hn::Set(d, 16.0f), wv), hn::Mul(w, v)));
        const auto explained =
            hn::Mul(hn::Mul(hn::Mul(covariance, covariance), hn::LoadU(d, table.inverse + i)), sixteenth);
        hn::StoreU(hn::Max(zero, hn::Sub(spread, explained)), d, errors[0] + i);

        // Relative to the offset of the half.
        const auto moved = hn::Sub(wv, hn::Mul(offset, w));
        const auto offset_twice = hn::Mul(two, offset);
        const auto base =
            hn::Add(hn::Sub(vv, hn::Mul(offset_twice, v)), hn::Mul(hn::Set(d, 16.0f), hn::Mul(offset, offset)));
        if (keeps_slope) {
            const auto both = hn::Sub(wv, hn::Mul(hn::Mul(w, v), sixteenth));
            const auto own = hn::Sub(ww, hn::Mul(hn::Mul(w, w), sixteenth));
            const auto gain = hn::Mul(slope, hn::Sub(hn::Mul(two, both), hn::Mul(slope, own)));
            hn::StoreU(hn::Max(zero, hn::Sub(spread, gain)), d, errors[1] + i);
        } else {
            const auto least = hn::Set(d, 1e-6f);
            const auto part = hn::Max(zero, moved);
            const auto gain = hn::Div(hn::Mul(part, part), hn::Max(ww, least));
            hn::StoreU(hn::Max(zero, hn::Sub(base, gain)), d, errors[1] + i);
        }
        const auto gain = hn::Mul(slope, hn::Sub(hn::Mul(two, moved), hn::Mul(slope, ww)));
        hn::StoreU(hn::Max(zero, hn::Sub(base, gain)), d, errors[2] + i);
    }
}

// From the last half on, because near ones cost least: so most of the others are dismissed without a root.
void add_cheapest_target(const CopyCosts& costs, int count, CheapCopies& cheapest) {
    const Floats d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const auto zero = hn::Zero(d);
    const auto rest = hn::Set(d, costs.rest);
    // Rounding must not dismiss what is below the bound.
    const auto square_scale = hn::Set(d, 0.9999f * costs.scale * costs.scale);
    HWY_ALIGN float squares[16];
    for (int i = (count - 1) / lanes * lanes; i >= 0; i -= lanes) {
        auto square = hn::LoadU(d, costs.errors + i);
        if (costs.more != nullptr) square = hn::Add(square, hn::LoadU(d, costs.more + i));
        square = hn::Add(square, rest);
        const auto room =
            hn::Max(zero, hn::Sub(hn::Set(d, cheapest.bound() - costs.extra), hn::LoadU(d, costs.prices + i)));
        if (hn::AllFalse(d, hn::Lt(hn::Mul(square_scale, square), hn::Mul(room, room)))) continue;
        hn::Store(square, d, squares);
        for (int k = std::min(lanes, count - i) - 1; k >= 0; --k) {
            const float cost = costs.scale * std::sqrt(squares[k]) + costs.prices[i + k] + costs.extra;
            if (cost < cheapest.bound()) cheapest.add({cost, i + k, costs.copied});
        }
    }
}

void block_chords_target(const float* const normals[3], const float x[16], const float y[16], float chords[16]) {
    const Floats d;
    const auto one = hn::Set(d, 1.0f);
    for (int i = 0; i < 16; i += static_cast<int>(hn::Lanes(d))) {
        const auto mx = hn::LoadU(d, x + i);
        const auto my = hn::LoadU(d, y + i);
        const auto flat = hn::Min(one, hn::Add(hn::Mul(mx, mx), hn::Mul(my, my)));
        const auto mz = hn::Sqrt(hn::Sub(one, flat));
        const auto dx = hn::Sub(hn::LoadU(d, normals[0] + i), mx);
        const auto dy = hn::Sub(hn::LoadU(d, normals[1] + i), my);
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
            const auto value = hn::LoadU(d, values + k * stride + i);
            const auto decoded = hn::Set(d, texels.decoded[k]);
            const auto flat = hn::Min(one, hn::Add(hn::Mul(value, value), hn::Mul(decoded, decoded)));
            const auto dv = hn::Sub(hn::Set(d, texels.own[k]), value);
            const auto dw = hn::Sub(hn::Set(d, texels.other[k]), decoded);
            const auto dz = hn::Sub(hn::Set(d, texels.z[k]), hn::Sqrt(hn::Sub(one, flat)));
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

HWY_EXPORT(copy_errors_target);
HWY_EXPORT(add_cheapest_target);
HWY_EXPORT(block_chords_target);
HWY_EXPORT(chord_sums_target);

void copy_errors(const LineTable& table, int count, const float values[16], bool keeps_slope, float* const errors[3]) {
    HWY_DYNAMIC_DISPATCH(copy_errors_target)(table, count, values, keeps_slope, errors);
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
