// SPDX-License-Identifier: Apache-2.0

#include "kernels/stored.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/stored.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/dispatch.h"
#include "kernels/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = FloatTag;
using V = FloatVec;
using M = FloatMask;

constexpr float kMost = std::numeric_limits<float>::max();
constexpr float kMostSquare = 16.0f;  // of a vector that is not replaced by 0

constexpr int kLanes = 16;  // of the sums, on every target

// The sums of x, y, z and the length.
struct VectorSums {
    double lane[4][kLanes] = {};

    [[nodiscard]] double total(int k) const {
        double sum = 0.0;
        for (const double part : lane[k]) sum += part;
        return sum;
    }
};

HWY_INLINE float ReconstructOne(float x, float y) {
    return std::sqrt(1.0f - std::min(std::max(x * x + y * y, 0.0f), 1.0f));
}

// One vector, for those that do not fill a register.
template <bool kHasZ>
void CountOne(const StoredRow& row, const VectorLimits& limits, int i, VectorCounts& counts, VectorSums& sums) {
    const auto mark = [&](VectorTrait trait, bool holds) {
        const auto k = static_cast<std::size_t>(trait);
        if (holds && counts.count[k]++ == 0) counts.first[k] = i;
    };
    const float x = row.x[i] * row.scale + row.offset, y = row.y[i] * row.scale + row.offset;
    const float flat = x * x + y * y;
    const float z = kHasZ ? row.z[i] * row.scale + row.offset : ReconstructOne(x, y);
    const float square = flat + z * z;
    if (!(square < kMost)) return mark(VectorTrait::not_finite, true);  // also if NaN
    mark(VectorTrait::beyond_unit, flat > limits.beyond_square);
    if constexpr (kHasZ) {
        mark(VectorTrait::null_vector, square < limits.null_square);
        mark(VectorTrait::off_length, square > limits.most_square || square < limits.least_square);
        mark(VectorTrait::z_below, z < limits.below);
        mark(VectorTrait::z_behind, z < limits.behind);
    }
    mark(VectorTrait::flat_low, row.x[i] == limits.low_flat && row.y[i] == limits.low_flat);
    mark(VectorTrait::flat_high, row.x[i] == limits.high_flat && row.y[i] == limits.high_flat);
    const float length = std::sqrt(square);
    ++counts.finite;
    const float values[4] = {x, y, z, length};
    for (int k = 0; k < 4; ++k) sums.lane[k][i % kLanes] += static_cast<double>(values[k]);
    counts.min_length = std::min(counts.min_length, length);
    counts.max_length = std::max(counts.max_length, length);
}

#if HWY_TARGET != HWY_SCALAR
constexpr std::size_t kParts = kLanes / hn::MaxLanes(D());  // registers for 16 texels

using Doubles = hn::Rebind<double, hn::Half<D> >;

// The sums of one quantity.
struct LaneSums {
    hn::Vec<Doubles> lower[kParts], upper[kParts];

    HWY_INLINE void Clear() {
        for (std::size_t k = 0; k < kParts; ++k) lower[k] = upper[k] = hn::Zero(Doubles());
    }
    HWY_INLINE void Add(D d, std::size_t part, V value) {
        lower[part] = hn::Add(lower[part], hn::PromoteTo(Doubles(), hn::LowerHalf(value)));
        upper[part] = hn::Add(upper[part], hn::PromoteTo(Doubles(), hn::UpperHalf(hn::Half<D>(), value)));
        (void)d;
    }
    HWY_INLINE void Store(double* lanes) const {
        constexpr std::size_t kHalf = hn::MaxLanes(Doubles());
        for (std::size_t k = 0; k < kParts; ++k) {
            hn::StoreU(lower[k], Doubles(), lanes + 2 * k * kHalf);
            hn::StoreU(upper[k], Doubles(), lanes + (2 * k + 1) * kHalf);
        }
    }
};

HWY_INLINE void Mark(D d, VectorTrait trait, M holds, int i, VectorCounts& counts) {
    if (hn::AllFalse(d, holds)) return;
    const auto k = static_cast<std::size_t>(trait);
    if (counts.count[k] == 0) counts.first[k] = i + static_cast<int>(hn::FindFirstTrue(d, holds));
    counts.count[k] += static_cast<int>(hn::CountTrue(d, holds));
}

HWY_INLINE V Reconstruct(D d, V x, V y) {
    const V one = hn::Set(d, 1.0f);
    return hn::Sqrt(hn::Sub(one, hn::Min(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), one)));
}

// Counts whole groups of 16 texels. Returns how many texels these are.
template <bool kHasZ>
int CountGroups(const StoredRow& row, const VectorLimits& limits, int width, VectorCounts& counts, VectorSums& sums) {
    const D d;
    const V scale = hn::Set(d, row.scale), offset = hn::Set(d, row.offset);
    LaneSums of_x, of_y, of_z, of_length;
    of_x.Clear(), of_y.Clear(), of_z.Clear(), of_length.Clear();
    V least = hn::Set(d, kMost), most = hn::Zero(d);
    const int end = width / kLanes * kLanes;
    for (int group = 0; group < end; group += kLanes) {
        for (std::size_t part = 0; part < kParts; ++part) {
            const int i = group + static_cast<int>(part * hn::MaxLanes(d));
            const V stored_x = hn::LoadU(d, row.x + i), stored_y = hn::LoadU(d, row.y + i);
            const V x = hn::Add(hn::Mul(stored_x, scale), offset), y = hn::Add(hn::Mul(stored_y, scale), offset);
            const V flat = hn::Add(hn::Mul(x, x), hn::Mul(y, y));
            V z;
            if constexpr (kHasZ)
                z = hn::Add(hn::Mul(hn::LoadU(d, row.z + i), scale), offset);
            else
                z = Reconstruct(d, x, y);
            const V square = hn::Add(flat, hn::Mul(z, z));
            const M finite = hn::Lt(square, hn::Set(d, kMost));
            Mark(d, VectorTrait::not_finite, hn::Not(finite), i, counts);
            const auto mark = [&](VectorTrait trait, M holds) { Mark(d, trait, hn::And(holds, finite), i, counts); };
            mark(VectorTrait::beyond_unit, hn::Gt(flat, hn::Set(d, limits.beyond_square)));
            if constexpr (kHasZ) {
                mark(VectorTrait::null_vector, hn::Lt(square, hn::Set(d, limits.null_square)));
                mark(VectorTrait::off_length, hn::Or(hn::Gt(square, hn::Set(d, limits.most_square)),
                                                     hn::Lt(square, hn::Set(d, limits.least_square))));
                mark(VectorTrait::z_below, hn::Lt(z, hn::Set(d, limits.below)));
                mark(VectorTrait::z_behind, hn::Lt(z, hn::Set(d, limits.behind)));
            }
            const auto both = [&](float value) {
                const V v = hn::Set(d, value);
                return hn::And(hn::Eq(stored_x, v), hn::Eq(stored_y, v));
            };
            mark(VectorTrait::flat_low, both(limits.low_flat));
            mark(VectorTrait::flat_high, both(limits.high_flat));
            const V length = hn::Sqrt(square);
            counts.finite += static_cast<int>(hn::CountTrue(d, finite));
            of_x.Add(d, part, hn::IfThenElseZero(finite, x));
            of_y.Add(d, part, hn::IfThenElseZero(finite, y));
            of_z.Add(d, part, hn::IfThenElseZero(finite, z));
            of_length.Add(d, part, hn::IfThenElseZero(finite, length));
            least = hn::Min(least, hn::IfThenElse(finite, length, hn::Set(d, kMost)));
            most = hn::Max(most, hn::IfThenElseZero(finite, length));
        }
    }
    of_x.Store(sums.lane[0]), of_y.Store(sums.lane[1]), of_z.Store(sums.lane[2]), of_length.Store(sums.lane[3]);
    counts.min_length = std::min(counts.min_length, hn::GetLane(hn::MinOfLanes(d, least)));
    counts.max_length = std::max(counts.max_length, hn::GetLane(hn::MaxOfLanes(d, most)));
    return end;
}
#endif

template <bool kHasZ>
void CountVectors(const StoredRow& row, const VectorLimits& limits, int width, VectorCounts& counts) {
    VectorSums sums;
    int i = 0;
#if HWY_TARGET != HWY_SCALAR
    i = CountGroups<kHasZ>(row, limits, width, counts, sums);
#endif
    for (; i < width; ++i) CountOne<kHasZ>(row, limits, i, counts, sums);
    counts.x += sums.total(0);
    counts.y += sums.total(1);
    counts.z += sums.total(2);
    counts.length += sums.total(3);
}

void CountStoredVectors(const StoredRow& row, const VectorLimits& limits, int width, VectorCounts& counts) {
    if (row.z != nullptr)
        CountVectors<true>(row, limits, width, counts);
    else
        CountVectors<false>(row, limits, width, counts);
}

void WidenRange(const float* values, int count, float& low, float& high) {
    int i = 0;
#if HWY_TARGET != HWY_SCALAR
    const D d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    V lows = hn::Set(d, low), highs = hn::Set(d, high);
    for (; i + lanes <= count; i += lanes) {
        const V value = hn::LoadU(d, values + i);
        lows = hn::IfThenElse(hn::Lt(value, lows), value, lows);
        highs = hn::IfThenElse(hn::Gt(value, highs), value, highs);
    }
    low = hn::GetLane(hn::MinOfLanes(d, lows));
    high = hn::GetLane(hn::MaxOfLanes(d, highs));
#endif
    for (; i < count; ++i) {
        low = std::min(low, values[i]);
        high = std::max(high, values[i]);
    }
}

HWY_INLINE void RestoreOne(const StoredRow& row, int i, float* x, float* y, float* z) {
    float nx = row.x[i] * row.scale + row.offset, ny = row.y[i] * row.scale + row.offset;
    if (row.z == nullptr) {
        const float beyond = std::max(1.0f, std::sqrt(nx * nx + ny * ny));
        nx = nx / beyond;
        ny = ny / beyond;
    }
    const float nz = row.z != nullptr ? row.z[i] * row.scale + row.offset : ReconstructOne(nx, ny);
    const bool usable = nx * nx + ny * ny + nz * nz <= kMostSquare;  // false for NaN
    x[i] = usable ? nx : 0.0f;
    y[i] = usable ? ny : 0.0f;
    z[i] = usable ? nz : 0.0f;
}

void RestoreStoredVectors(const StoredRow& row, int width, float* x, float* y, float* z) {
    int i = 0;
#if HWY_TARGET != HWY_SCALAR
    const D d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const V scale = hn::Set(d, row.scale), offset = hn::Set(d, row.offset), one = hn::Set(d, 1.0f);
    for (; i + lanes <= width; i += lanes) {
        Vec3 n;
        n.x = hn::Add(hn::Mul(hn::LoadU(d, row.x + i), scale), offset);
        n.y = hn::Add(hn::Mul(hn::LoadU(d, row.y + i), scale), offset);
        if (row.z != nullptr) {
            n.z = hn::Add(hn::Mul(hn::LoadU(d, row.z + i), scale), offset);
        } else {
            const V beyond = hn::Max(one, hn::Sqrt(hn::Add(hn::Mul(n.x, n.x), hn::Mul(n.y, n.y))));
            n.x = hn::Div(n.x, beyond);
            n.y = hn::Div(n.y, beyond);
            n.z = Reconstruct(d, n.x, n.y);
        }
        const V square = hn::Add(hn::Add(hn::Mul(n.x, n.x), hn::Mul(n.y, n.y)), hn::Mul(n.z, n.z));
        const M usable = hn::Le(square, hn::Set(d, kMostSquare));
        hn::StoreU(hn::IfThenElseZero(usable, n.x), d, x + i);
        hn::StoreU(hn::IfThenElseZero(usable, n.y), d, y + i);
        hn::StoreU(hn::IfThenElseZero(usable, n.z), d, z + i);
    }
#endif
    for (; i < width; ++i) RestoreOne(row, i, x, y, z);
}

void AveragePairs(const float* upper, const float* lower, int count, float* out) {
    int i = 0;
#if HWY_TARGET != HWY_SCALAR
    const D d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const V quarter = hn::Set(d, 0.25f);
    V upper_even, upper_odd, lower_even, lower_odd;
    for (; i + lanes <= count; i += lanes) {
        const std::ptrdiff_t first = std::ptrdiff_t{2} * i;
        hn::LoadInterleaved2(d, upper + first, upper_even, upper_odd);
        hn::LoadInterleaved2(d, lower + first, lower_even, lower_odd);
        const V sum = hn::Add(hn::Add(hn::Add(upper_even, upper_odd), lower_even), lower_odd);
        hn::StoreU(hn::Mul(sum, quarter), d, out + i);
    }
#endif
    for (; i < count; ++i) {
        const std::ptrdiff_t first = std::ptrdiff_t{2} * i;
        out[i] = (upper[first] + upper[first + 1] + lower[first] + lower[first + 1]) * 0.25f;
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, count_stored_vectors, CountStoredVectors,
           (const StoredRow& row, const VectorLimits& limits, int width, VectorCounts& counts),
           (row, limits, width, counts))

TEX_KERNEL(void, widen_range, WidenRange, (const float* values, int count, float& low, float& high),
           (values, count, low, high))

TEX_KERNEL(void, restore_stored_vectors, RestoreStoredVectors,
           (const StoredRow& row, int width, float* x, float* y, float* z), (row, width, x, y, z))

TEX_KERNEL(void, average_pairs, AveragePairs, (const float* upper, const float* lower, int count, float* out),
           (upper, lower, count, out))

}  // namespace tex::inline v1
#endif
