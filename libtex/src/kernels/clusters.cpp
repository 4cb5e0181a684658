// SPDX-License-Identifier: Apache-2.0

#include "kernels/clusters.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/clusters.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, 16>;
using F = hn::Vec<Floats>;

// Batcher's odd-even merge sort of 16 vectors, lane by lane.
void sort16(F* v) {
    for (int p = 1; p < 16; p *= 2) {
        for (int k = p; k >= 1; k /= 2) {
            for (int j = k % p; j + k < 16; j += 2 * k) {
                for (int i = 0; i < k && i + j + k < 16; ++i) {
                    if ((i + j) / (2 * p) != (i + j + k) / (2 * p)) continue;
                    const F low = hn::Min(v[i + j], v[i + j + k]);
                    v[i + j + k] = hn::Max(v[i + j], v[i + j + k]);
                    v[i + j] = low;
                }
            }
        }
    }
}

// Computes the bounds of as many blocks as there are lanes. `texels` holds 16 rows of one value for each block.
void bound_lanes(const float* texels, float* bounds) {
    const Floats d;
    const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
    F v[16];
    for (int k = 0; k < 16; ++k) v[k] = hn::Load(d, texels + k * lanes);
    sort16(v);
    // Sums from the first texel on, of the values minus the middle of the range: small numbers have a small rounding
    // error.
    const F range = hn::Sub(v[15], v[0]);
    const F middle = hn::Mul(hn::Add(v[15], v[0]), hn::Set(d, 0.5f));
    F sum[17], squares[17];
    sum[0] = squares[0] = hn::Zero(d);
    for (int k = 0; k < 16; ++k) {
        const F x = hn::Sub(v[k], middle);
        sum[k + 1] = hn::Add(sum[k], x);
        squares[k + 1] = hn::Add(squares[k], hn::Mul(x, x));
    }
    const auto cost = [&](int first, int last) {
        const F s = hn::Sub(sum[last + 1], sum[first]);
        const F q = hn::Sub(squares[last + 1], squares[first]);
        return hn::Sub(q, hn::Mul(hn::Mul(s, s), hn::Set(d, 1.0f / static_cast<float>(last - first + 1))));
    };
    HWY_ALIGN float costs[16 * 16 * 16];
    for (int i = 1; i < 16; ++i) {
        for (int j = i; j < 16; ++j) hn::Store(cost(i, j), d, costs + (i * 16 + j) * lanes);
    }
    F least[16];
    for (int j = 0; j < 16; ++j) least[j] = cost(0, j);
    const F slack = hn::Mul(hn::Mul(range, range), hn::Set(d, 1e-5f));
    const auto report = [&](int k, F error) {
        hn::Store(hn::Max(hn::Sub(error, slack), hn::Zero(d)), d, bounds + k * lanes);
    };
    report(0, least[15]);
    for (int k = 1; k < kMaxClusters; ++k) {
        // In place, from the last texel down, because the error up to j needs the errors of earlier texels with fewer
        // clusters.
        const int lowest = k + 1 < kMaxClusters ? k : 15;
        for (int j = 15; j >= lowest; --j) {
            F error = hn::Add(least[k - 1], hn::Load(d, costs + (k * 16 + j) * lanes));
            for (int i = k + 1; i <= j; ++i) {
                error = hn::Min(error, hn::Add(least[i - 1], hn::Load(d, costs + (i * 16 + j) * lanes)));
            }
            least[j] = error;
        }
        report(k, least[15]);
    }
}

void cluster_bounds(const BlockTexels* blocks, int count, ClusterBounds* out) {
    const Floats d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    HWY_ALIGN float texels[16 * 16];
    HWY_ALIGN float bounds[kMaxClusters * 16];
    for (int first = 0; first < count; first += lanes) {
        for (int lane = 0; lane < lanes; ++lane) {
            const BlockTexels& block = blocks[std::min(first + lane, count - 1)];
            for (int k = 0; k < 16; ++k) {
                texels[k * lanes + lane] = static_cast<float>(block.values[k]) * (1.0f / kCodeUnit);
            }
        }
        bound_lanes(texels, bounds);
        for (int lane = 0; lane < std::min(lanes, count - first); ++lane) {
            const bool whole = blocks[first + lane].mask == 0xFFFF;
            for (int k = 0; k < kMaxClusters; ++k) {
                out[first + lane].bound[k] = whole ? bounds[k * lanes + lane] : 0.0f;
            }
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, cluster_bounds, cluster_bounds, (const BlockTexels* blocks, int count, ClusterBounds* bounds),
           (blocks, count, bounds))

}  // namespace tex::inline v1
#endif  // HWY_ONCE
