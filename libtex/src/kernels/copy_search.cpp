// SPDX-License-Identifier: Apache-2.0

#include "kernels/copy_search.h"

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

void add_cheapest_target(const CopyCosts& costs, int count, CheapCopies& cheapest) {
    const Floats d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const auto scale = hn::Set(d, costs.scale);
    const auto rest = hn::Set(d, costs.rest);
    const auto extra = hn::Set(d, costs.extra);
    HWY_ALIGN float found[16];
    for (int i = 0; i < count; i += lanes) {
        auto square = hn::LoadU(d, costs.errors + i);
        if (costs.more != nullptr) square = hn::Add(square, hn::LoadU(d, costs.more + i));
        const auto length = hn::Mul(scale, hn::Sqrt(hn::Add(square, rest)));
        const auto cost = hn::Add(hn::Add(length, hn::LoadU(d, costs.prices + i)), extra);
        if (hn::AllFalse(d, hn::Lt(cost, hn::Set(d, cheapest.bound())))) continue;
        hn::Store(cost, d, found);
        for (int k = 0; k < lanes && i + k < count; ++k) {
            if (found[k] < cheapest.bound()) cheapest.add({found[k], i + k, costs.copied});
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

}  // namespace HWY_NAMESPACE
}  // namespace tex
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex {

HWY_EXPORT(copy_errors_target);
HWY_EXPORT(add_cheapest_target);
HWY_EXPORT(block_chords_target);

void copy_errors(const LineTable& table, int count, const float values[16], bool keeps_slope, float* const errors[3]) {
    HWY_DYNAMIC_DISPATCH(copy_errors_target)(table, count, values, keeps_slope, errors);
}

void add_cheapest(const CopyCosts& costs, int count, CheapCopies& cheapest) {
    HWY_DYNAMIC_DISPATCH(add_cheapest_target)(costs, count, cheapest);
}

void block_chords(const float* const normals[3], const float x[16], const float y[16], float chords[16]) {
    HWY_DYNAMIC_DISPATCH(block_chords_target)(normals, x, y, chords);
}

}  // namespace tex
#endif
