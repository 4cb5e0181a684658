// SPDX-License-Identifier: Apache-2.0

#include "kernels/deband.h"

#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/deband.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, 16>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;
constexpr D kD;
constexpr int kLanes = static_cast<int>(hn::MaxLanes(kD));

// How far a height may be from its code. What is missing to a half makes up for the rounding of floats.
constexpr float kReach = 0.499f;
// The greatest energy of a texel: beyond, the ground is a cliff, and a greater one would only spread farther.
constexpr float kMostEnergy = 1e6f;
// With a greater weight, heights stay at their codes. They would move by about 1 / sqrt(12 weight), a sixtieth of a
// step, which helps no rough ground, but bends the plateaus between cliffs.
constexpr float kMostWeight = 300.0f;
constexpr float kHolds = 1e12f;
// The largest eigenvalue of the squared Laplacian.
constexpr float kStiffest = 64.0f;

HWY_INLINE V set(float value) { return hn::Set(kD, value); }
HWY_INLINE V load(const float* row) { return hn::LoadU(kD, row); }

void CodesOfHeights(float lowest, float step, int count, float* row) {
    for (int i = 0; i < count; i += kLanes) {
        const V code = hn::Round(hn::Div(hn::Sub(load(row + i), set(lowest)), set(step)));
        hn::StoreU(hn::IfThenElse(hn::IsNaN(load(row + i)), load(row + i), code), kD, row + i);
    }
}

void HeightsOfCodes(const float* codes, float lowest, float step, int count, float* row) {
    const V from = set(lowest), by = set(step);
    for (int i = 0; i < count; i += kLanes) {
        const V code = load(codes + i);
        const V height = hn::Add(from, hn::Mul(by, load(row + i)));
        const M same = hn::Eq(hn::Round(hn::Div(hn::Sub(height, from), by)), code);
        const V kept = hn::Add(from, hn::Mul(by, code));  // NaN if the code is
        hn::StoreU(hn::IfThenElse(same, height, kept), kD, row + i);
    }
}

void ExtrapolateRow(const float* a, const float* b, float factor, int count, float* out) {
    for (int i = 0; i < count; i += kLanes) {
        const V at = load(a + i);
        hn::StoreU(hn::Add(at, hn::Mul(set(factor), hn::Sub(at, load(b + i)))), kD, out + i);
    }
}

HWY_INLINE V laplacian(const float* above, const float* row, const float* below) {
    const V around = hn::Add(hn::Add(load(above), load(below)), hn::Add(load(row - 1), load(row + 1)));
    return hn::Sub(around, hn::Mul(set(4.0f), load(row)));
}

void LaplaceRow(const float* above, const float* row, const float* below, int count, float* out) {
    for (int i = -1; i <= count; i += kLanes) hn::StoreU(laplacian(above + i, row + i, below + i), kD, out + i);
}

void SquareRow(int count, float* row) {
    for (int i = 0; i < count; i += kLanes) {
        const V value = load(row + i);
        const V square = hn::Min(hn::Mul(value, value), set(kMostEnergy));
        hn::StoreU(hn::IfThenZeroElse(hn::IsNaN(value), square), kD, row + i);
    }
}

// The height within the bounds; without a code, as it is.
HWY_INLINE V limited(V height, V code, V least, V greatest) {
    const V low = hn::Max(hn::Sub(code, set(kReach)), least);
    const V high = hn::Min(hn::Add(code, set(kReach)), greatest);
    return hn::IfThenElse(hn::IsNaN(code), height, hn::Min(hn::Max(height, low), high));
}

void RelaxRow(const BendingRow& in, CodeRange range, int count, float* out) {
    const V least = set(range.least), greatest = set(range.greatest);
    for (int i = 0; i < count; i += kLanes) {
        const V height = load(in.heights + i);
        const V code = load(in.codes + i);
        const V weight = hn::IfThenZeroElse(hn::IsNaN(code), load(in.weights + i));
        const V pull = hn::IfThenZeroElse(hn::IsNaN(code), hn::Mul(weight, hn::Sub(height, code)));
        const V gradient = hn::Add(laplacian(in.above + i, in.at + i, in.below + i), pull);
        const V moved = hn::Sub(height, hn::Div(gradient, hn::Add(set(kStiffest), weight)));
        hn::StoreU(limited(moved, code, least, greatest), kD, out + i);
    }
}

// Both texels of each pair in `row`, from pair i on.
struct Pairs {
    V even, odd;
};
HWY_INLINE Pairs pairs_at(const float* row, int i) {
    Pairs pairs;
    hn::LoadInterleaved2(kD, row + std::ptrdiff_t{2} * i, pairs.even, pairs.odd);
    return pairs;
}

HWY_INLINE V known_or(V code, V otherwise) { return hn::IfThenElse(hn::IsNaN(code), otherwise, code); }

void HalveCodes(const float* upper, const float* lower, int count, float* out) {
    for (int i = 0; i < count; i += kLanes) {
        const Pairs a = pairs_at(upper, i), b = pairs_at(lower, i);
        hn::StoreU(known_or(a.even, known_or(a.odd, known_or(b.even, b.odd))), kD, out + i);
    }
}

void HalveMeans(const float* upper, const float* lower, int count, float* out) {
    for (int i = 0; i < count; i += kLanes) {
        const Pairs a = pairs_at(upper, i), b = pairs_at(lower, i);
        const V sum = hn::Add(hn::Add(a.even, a.odd), hn::Add(b.even, b.odd));
        hn::StoreU(hn::Mul(set(0.25f), sum), kD, out + i);
    }
}

HWY_INLINE V between(V before, V left, V right, V after) {
    const V near = hn::Mul(set(9.0f / 16.0f), hn::Add(left, right));
    return hn::Sub(near, hn::Mul(set(1.0f / 16.0f), hn::Add(before, after)));
}

void BetweenRows(const float* const rows[4], int count, float* out) {
    for (int i = 0; i < count; i += kLanes)
        hn::StoreU(between(load(rows[0] + i), load(rows[1] + i), load(rows[2] + i), load(rows[3] + i)), kD, out + i);
}

void DoubleRow(const float* row, int count, float* out) {
    for (int i = 0; i < count; i += kLanes) {
        const float* const at = row + i;
        const V odd = between(load(at - 1), load(at), load(at + 1), load(at + 2));
        hn::StoreInterleaved2(load(at), odd, kD, out + std::ptrdiff_t{2} * i);
    }
}

void RepeatTexels(const float* row, int count, float* out) {
    for (int i = 0; i < count; i += kLanes)
        hn::StoreInterleaved2(load(row + i), load(row + i), kD, out + std::ptrdiff_t{2} * i);
}

void LimitRow(const float* codes, CodeRange range, int count, float* row) {
    const V least = set(range.least), greatest = set(range.greatest);
    for (int i = 0; i < count; i += kLanes) {
        const V value = known_or(load(row + i), least);
        hn::StoreU(limited(value, load(codes + i), least, greatest), kD, row + i);
    }
}

void WeightsOfEnergy(float noise, float significant, float factor, int count, float* row) {
    for (int i = 0; i < count; i += kLanes) {
        const V energy = load(row + i);
        const V weight = hn::Mul(set(factor), hn::Max(hn::Sub(energy, set(noise)), hn::Zero(kD)));
        const V held = hn::IfThenElse(hn::Gt(weight, set(kMostWeight)), set(kHolds), weight);
        hn::StoreU(hn::IfThenElseZero(hn::Gt(energy, set(significant)), held), kD, row + i);
    }
}

void LeastOf(const float* other, int count, float* row) {
    for (int i = 0; i < count; i += kLanes) hn::StoreU(hn::Min(load(row + i), load(other + i)), kD, row + i);
}

void GreatestOf(float factor, float factor_of_other, const float* other, int count, float* row) {
    for (int i = 0; i < count; i += kLanes) {
        const V own = hn::Mul(set(factor), load(row + i));
        hn::StoreU(hn::Max(own, hn::Mul(set(factor_of_other), load(other + i))), kD, row + i);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, codes_of_heights, CodesOfHeights, (float lowest, float step, int count, float* row),
           (lowest, step, count, row))

TEX_KERNEL(void, heights_of_codes, HeightsOfCodes,
           (const float* codes, float lowest, float step, int count, float* row), (codes, lowest, step, count, row))

TEX_KERNEL(void, extrapolate_row, ExtrapolateRow, (const float* a, const float* b, float factor, int count, float* out),
           (a, b, factor, count, out))

TEX_KERNEL(void, laplace_row, LaplaceRow,
           (const float* above, const float* row, const float* below, int count, float* out),
           (above, row, below, count, out))

TEX_KERNEL(void, square_row, SquareRow, (int count, float* row), (count, row))

TEX_KERNEL(void, relax_row, RelaxRow, (const BendingRow& in, CodeRange range, int count, float* out),
           (in, range, count, out))

TEX_KERNEL(void, halve_codes, HalveCodes, (const float* upper, const float* lower, int count, float* out),
           (upper, lower, count, out))

TEX_KERNEL(void, halve_means, HalveMeans, (const float* upper, const float* lower, int count, float* out),
           (upper, lower, count, out))

TEX_KERNEL(void, between_rows, BetweenRows, (const float* const rows[4], int count, float* out), (rows, count, out))

TEX_KERNEL(void, double_row, DoubleRow, (const float* row, int count, float* out), (row, count, out))

TEX_KERNEL(void, repeat_texels, RepeatTexels, (const float* row, int count, float* out), (row, count, out))

TEX_KERNEL(void, limit_row, LimitRow, (const float* codes, CodeRange range, int count, float* row),
           (codes, range, count, row))

TEX_KERNEL(void, weights_of_energy, WeightsOfEnergy,
           (float noise, float significant, float factor, int count, float* row),
           (noise, significant, factor, count, row))

TEX_KERNEL(void, least_of, LeastOf, (const float* other, int count, float* row), (other, count, row))

TEX_KERNEL(void, greatest_of, GreatestOf,
           (float factor, float factor_of_other, const float* other, int count, float* row),
           (factor, factor_of_other, other, count, row))

}  // namespace tex::inline v1
#endif  // HWY_ONCE
