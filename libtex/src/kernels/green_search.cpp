// SPDX-License-Identifier: Apache-2.0

#include "kernels/green_search.h"

#include <algorithm>
#include <cmath>

#include "kernels/block.h"
#include "kernels/candidates.h"
#include "kernels/single_greens.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/green_search.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/dispatch.h"

#ifndef TEX_GREEN_SEARCH_ONCE
#define TEX_GREEN_SEARCH_ONCE
namespace tex::inline v1 {
namespace {

struct ExactError {
    const BlockTexels& texels;
    std::int64_t operator()(const Candidate& c) const { return green_error(texels, {c.lower, c.lower + c.distance}); }
};

using GreenCandidates = Candidates<ExactError>;

}  // namespace
}  // namespace tex::inline v1
#endif

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, 16>;
using Ints = hn::Rebind<std::int32_t, Floats>;
using F = hn::Vec<Floats>;
using I = hn::Vec<Ints>;

// G at base + i / 6 codes, in sixths of a code, for i up to 6 * length; 0 at both ends.
using Gains = float[6 * 256 + 32];

void tabulate(const Block& block, Gains& gains) {
    const Floats d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    F v[16];
    F total = hn::Zero(d);
    for (int k = 0; k < 16; ++k) {
        v[k] = hn::Set(d, block.v[k] * 6.0f);
        total = hn::Add(total, v[k]);
    }
    const int end = 6 * block.length;
    for (int i = 0; i <= end; i += lanes) {
        const F t = hn::Iota(d, static_cast<float>(i));
        F sum = hn::Max(v[0], t);
        for (int k = 1; k < 16; ++k) sum = hn::Add(sum, hn::Max(v[k], t));
        hn::Store(hn::Sub(sum, hn::Max(total, hn::Mul(t, hn::Set(d, 16.0f)))), d, gains + i);
    }
    gains[end] = 0.0f;
}

I widen(I code) { return hn::Or(hn::ShiftLeft<2>(code), hn::ShiftRight<4>(code)); }

// Scores the pairs with lower endpoints `first` to `last` and the greater endpoint `distance` above.
void score(const Block& block, const Gains& gains, int first, int last, int distance, GreenCandidates& candidates) {
    const Floats d;
    const Ints di;
    const int lanes = static_cast<int>(hn::Lanes(d));
    HWY_ALIGN float errors[16];
    const I zero = hn::Zero(di);
    const I end = hn::Set(di, 6 * block.length);
    for (int lower = first; lower <= last; lower += lanes) {
        const I code = hn::Iota(di, lower);
        const I low = hn::Sub(widen(code), hn::Set(di, block.base));
        const I high = hn::Sub(widen(hn::Add(code, hn::Set(di, distance))), hn::Set(di, block.base));
        const I sum = hn::Add(low, high);
        const I low4 = hn::ShiftLeft<2>(low);
        const I high4 = hn::ShiftLeft<2>(high);
        const auto gain = [&](I t) { return hn::GatherIndex(d, gains, hn::Min(hn::Max(t, zero), end)); };
        const F total = hn::Add(hn::Add(gain(hn::Add(sum, low4)), gain(hn::Add(hn::Add(sum, sum), sum))),
                                gain(hn::Add(sum, high4)));
        const F span = hn::ConvertTo(d, hn::Sub(high, low));
        const F spacing = hn::Mul(span, hn::Set(d, 1.0f / 3.0f));
        const F from_low = hn::Sub(hn::Set(d, block.mean), hn::ConvertTo(d, low));
        const F index = hn::Floor(hn::Add(hn::Div(from_low, hn::Max(spacing, hn::Set(d, 0.5f))), hn::Set(d, 0.5f)));
        const F clamped = hn::Min(hn::Max(index, hn::Zero(d)), hn::Set(d, 3.0f));
        const F away = hn::Sub(from_low, hn::Mul(clamped, spacing));
        // 2 * spacing * gains in sixths.
        const F gained = hn::Mul(hn::Mul(span, hn::Set(d, 1.0f / 9.0f)), total);
        const F error = hn::Sub(
            hn::Add(hn::Set(d, block.deviations), hn::Mul(hn::Set(d, block.count), hn::Mul(away, away))), gained);
        const auto valid = hn::Lt(code, hn::Set(di, last + 1));
        if (hn::AllFalse(d, hn::And(hn::RebindMask(d, valid), hn::Le(error, hn::Set(d, candidates.limit()))))) continue;
        hn::Store(error, d, errors);
        for (int lane = 0; lane < std::min(lanes, last - lower + 1); ++lane) {
            candidates.add({errors[lane], lower + lane, distance, 0});
        }
    }
}

// The least 6-bit code whose green is at least `value`, and the greatest whose green is at most `value`.
int code_above(float value) {
    const int code = std::clamp(static_cast<int>(std::ceil((value - 3.0f) * 0.25f)), 0, 63);
    const int low = std::max(0, code - 1);
    return static_cast<float>(widen_green(low)) >= value    ? low
           : static_cast<float>(widen_green(code)) >= value ? code
                                                            : code + 1;
}
int code_below(float value) {
    const int code = std::clamp(static_cast<int>(std::floor(value * 0.25f)), 0, 63);
    return static_cast<float>(widen_green(code)) <= value ? code : code - 1;
}

void score_near(const Block& block, const Gains& gains, int distance, GreenCandidates& candidates) {
    const float base = static_cast<float>(block.base);
    const float s = std::sqrt(std::max(candidates.limit(), 0.0f));
    const int last = std::min(63 - distance, code_below(base + block.least + s));
    const int first = std::max(0, code_above(base + block.greatest - s) - distance);
    score(block, gains, first, last, distance, candidates);
}

GreenEndpoints search(const BlockTexels& texels, const ClusterBounds& bounds, Gains& gains) {
    const Block block = measure(texels);
    GreenCandidates candidates(block.slack, {texels});
    // Try one value for all texels.
    const float base = static_cast<float>(block.base);
    const int third = static_cast<int>((base + block.mean) * 3.0f);
    for (const SingleGreen& entry : {single_green_below(third), single_green_above(std::min(third + 1, 765))}) {
        const float away = static_cast<float>(entry.third) / 3.0f - (base + block.mean);
        candidates.add({block.deviations + block.count * away * away, entry.lower, entry.distance, 0});
    }
    const float range = block.greatest - block.least;
    if (block.length > 0) tabulate(block, gains);
    // Start with endpoints at and near the extremes.
    const int low = std::clamp(static_cast<int>((base + block.least) * 0.25f), 0, 63);
    const int high = std::clamp(static_cast<int>((base + block.greatest) * 0.25f), low, 63);
    const int start = high - low;
    if (block.length > 0) score(block, gains, std::max(0, low - 2), std::min(63 - start, low + 2), start, candidates);
    for (int distance = start; distance < 64 && block.length > 0 && !candidates.perfect(); ++distance) {
        const float spacing = static_cast<float>(4 * distance) / 3.0f;
        const int thresholds =
            spacing * 3.0f <= range ? 3 : std::min(3, static_cast<int>(range / spacing * 1.0001f) + 1);
        if (bounds.bound[thresholds] > candidates.limit()) break;
        const float apart = 0.5f * spacing - range;
        if (apart > 0.0f && block.count * apart * apart > candidates.limit()) break;
        score_near(block, gains, distance, candidates);
    }
    for (int distance = start - 1; distance >= 0 && !candidates.perfect(); --distance) {
        const float outside = range - static_cast<float>(4 * distance + 3);
        if (outside > 0.0f && 0.5f * outside * outside > candidates.limit()) break;
        score_near(block, gains, distance, candidates);
    }
    const Candidate best = candidates.settle();
    return {best.lower, best.lower + best.distance};
}

void search_green_blocks(const BlockTexels* blocks, const ClusterBounds* bounds, int count, GreenEndpoints* endpoints) {
    HWY_ALIGN Gains gains;
    for (int k = 0; k < count; ++k) endpoints[k] = search(blocks[k], bounds[k], gains);
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, search_green_blocks, search_green_blocks,
           (const BlockTexels* blocks, const ClusterBounds* bounds, int count, GreenEndpoints* endpoints),
           (blocks, bounds, count, endpoints))

}  // namespace tex::inline v1
#endif  // HWY_ONCE
