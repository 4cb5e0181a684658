// SPDX-License-Identifier: Apache-2.0

#include "kernels/bc4_search.h"

#include <algorithm>
#include <cmath>

#include "kernels/block.h"
#include "kernels/candidates.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/bc4_search.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, 16>;
using F = hn::Vec<Floats>;

// G on a grid of 1/phases code: row r holds G(base + i + r / phases) from i = -16 on, and zeros outside the block's
// range. The unit is 1/phases code.
constexpr int kMaxPhases = 14;
constexpr int kPad = 16;
constexpr std::ptrdiff_t kRow = kPad + 272 + kPad;

struct Gains {
    HWY_ALIGN float rows[kMaxPhases * kRow];
    // For 6 values, in codes squared. `below` is for the threshold between the lowest code and the lower endpoint e;
    // `above` is for the threshold between the greater endpoint e and the greatest code. Entry e holds the gain times
    // the distance of the two.
    HWY_ALIGN float below[kRow], above[kRow];

    Gains() { std::fill(std::begin(rows), std::end(rows), 0.0f); }
};

void tabulate(const Block& block, int phases, Gains& gains) {
    const Floats d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const float scale = static_cast<float>(phases);
    F v[16];
    F total = hn::Zero(d);
    for (int k = 0; k < 16; ++k) {
        v[k] = hn::Set(d, block.v[k] * scale);
        total = hn::Add(total, v[k]);
    }
    const F codes = hn::Mul(hn::Iota(d, 0.0f), hn::Set(d, scale));
    for (int r = 0; r < phases; ++r) {
        float* row = gains.rows + r * kRow + kPad;
        int i = 0;
        for (; i < block.length; i += lanes) {
            const F t = hn::Add(codes, hn::Set(d, static_cast<float>(i) * scale + static_cast<float>(r)));
            F sum = hn::Max(v[0], t);
            for (int k = 1; k < 16; ++k) sum = hn::Add(sum, hn::Max(v[k], t));
            hn::StoreU(hn::Sub(sum, hn::Max(total, hn::Mul(t, hn::Set(d, 16.0f)))), d, row + i);
        }
        for (const int end = i + 16; i < end; i += lanes) hn::StoreU(hn::Zero(d), d, row + i);
    }
}

Bc4Endpoints endpoints_of(const Candidate& c) {
    return c.kind == 0 ? Bc4Endpoints{c.lower + c.distance, c.lower} : Bc4Endpoints{c.lower, c.lower + c.distance};
}

struct ExactError {
    const BlockTexels& texels;
    Bc4Codes codes;
    std::int64_t operator()(const Candidate& c) const { return bc4_error(texels, codes, endpoints_of(c)); }
};

using Bc4Candidates = Candidates<ExactError>;

// Scores pairs of one type (8 or 6 values).
class Scorer {
public:
    Scorer(const Block& block, const Gains& gains, bool eight_values, int top, bool open_below, bool open_above)
        : block_(block), gains_(gains), eight_values_(eight_values), steps_(eight_values ? 7 : 5), top_(top),
          open_below_(open_below), open_above_(open_above) {}

    // Scores all lower endpoints from `first` to `last` (absolute codes), with the greater endpoint `distance` above.
    // Returns the least error.
    float score(int first, int last, int distance, Bc4Candidates& candidates) const {
        const Floats d;
        const int lanes = static_cast<int>(hn::Lanes(d));
        const int phases = 2 * steps_;
        const float inverse = 1.0f / static_cast<float>(phases);
        const F spacing = hn::Set(d, static_cast<float>(distance) / static_cast<float>(steps_));
        const F per_spacing =
            hn::Set(d, distance == 0 ? 0.0f : static_cast<float>(steps_) / static_cast<float>(distance));
        // Gains are in units of 1/phases code. Multiplied by twice the spacing, they are in codes squared.
        const F weight = hn::Set(d, 2.0f * static_cast<float>(distance) / static_cast<float>(steps_) * inverse);
        HWY_ALIGN float errors[16];
        F least = hn::Set(d, 1e30f);
        for (int lower = first; lower <= last; lower += lanes) {
            const int offset = lower - block_.base;
            F gain = hn::Zero(d);
            for (int j = 0; j < steps_; ++j) {
                const int t = (2 * j + 1) * distance;
                const int i = offset + t / phases;
                if (i <= -lanes) continue;
                if (i >= block_.length) break;
                gain = hn::Add(gain, hn::LoadU(d, gains_.rows + t % phases * kRow + kPad + i));
            }
            const F low = hn::Add(hn::Iota(d, 0.0f), hn::Set(d, static_cast<float>(offset)));
            const F from_low = hn::Sub(hn::Set(d, block_.mean), low);
            const F index = hn::Floor(hn::Add(hn::Mul(from_low, per_spacing), hn::Set(d, 0.5f)));
            const F clamped = hn::Min(hn::Max(index, hn::Zero(d)), hn::Set(d, static_cast<float>(steps_)));
            F away = hn::Abs(hn::Sub(from_low, hn::Mul(clamped, spacing)));
            F total = hn::Mul(weight, gain);
            if (open_below_) {
                away = hn::Min(away, hn::Set(d, block_.mean + static_cast<float>(block_.base)));
                total = hn::Add(total, hn::LoadU(d, gains_.below + lower));
            }
            if (open_above_) {
                away = hn::Min(away, hn::Set(d, static_cast<float>(top_ - block_.base) - block_.mean));
                total = hn::Add(total, hn::LoadU(d, gains_.above + lower + distance));
            }
            const F error = hn::Sub(
                hn::Add(hn::Set(d, block_.deviations), hn::Mul(hn::Set(d, block_.count), hn::Mul(away, away))), total);
            const auto valid = hn::Lt(hn::Iota(d, 0.0f), hn::Set(d, static_cast<float>(last - lower + 1)));
            least = hn::IfThenElse(valid, hn::Min(least, error), least);
            if (hn::AllFalse(d, hn::And(valid, hn::Le(error, hn::Set(d, candidates.limit()))))) continue;
            hn::Store(error, d, errors);
            for (int lane = 0; lane < std::min(lanes, last - lower + 1); ++lane) {
                candidates.add({errors[lane], lower + lane, distance, eight_values_ ? 0 : 1});
            }
        }
        return hn::GetLane(hn::MinOfLanes(d, least));
    }

    // Scores the pairs of that distance that may be as good as the limit. Returns the number of distances after this
    // one that cannot hold a better pair.
    int score_near(int distance, Bc4Candidates& candidates) const {
        const float s = std::sqrt(std::max(candidates.limit(), 0.0f));
        const float highest = open_below_ ? 255.0f : std::floor(block_.least + s);
        const float lowest = open_above_ ? -255.0f : std::ceil(block_.greatest - s) - static_cast<float>(distance);
        const int first = std::max(0, block_.base + static_cast<int>(std::max(lowest, -255.0f)));
        const int last = std::min(top_ - distance, block_.base + static_cast<int>(std::min(highest, 255.0f)));
        if (first > last) return 0;
        const float least = score(first, last, distance, candidates);
        // If an endpoint moves by one code, the root of the error changes by at most the root of the number of texels,
        // 4.
        return static_cast<int>(0.2499f *
                                (std::sqrt(std::max(least - block_.slack, 0.0f)) - std::sqrt(candidates.limit())));
    }

    void search(const ClusterBounds& bounds, Bc4Candidates& candidates) const {
        const float range = block_.greatest - block_.least;
        const int smallest = eight_values_ ? 1 : 0;
        if (block_.deviations <= candidates.limit() || block_.length <= 1) score_near(1, candidates);
        const bool open = open_below_ || open_above_;
        const int start = std::max(smallest, std::min(block_.length, top_));
        for (int distance = start; distance <= top_; ++distance) {
            const float spacing = static_cast<float>(distance) / static_cast<float>(steps_);
            const int thresholds = std::min(steps_, static_cast<int>(range / spacing * 1.0001f) + 1);
            const int entries = thresholds + 1 + open_below_ + open_above_;
            if (entries <= kMaxClusters && bounds.bound[entries - 1] > candidates.limit()) break;
            const float apart = 0.5f * spacing - range;
            if (!open && apart > 0.0f && block_.count * apart * apart > candidates.limit()) break;
            if (candidates.perfect()) return;
            distance += std::max(0, score_near(distance, candidates));
        }
        for (int distance = start - 1; distance >= smallest; --distance) {
            const float outside = range - static_cast<float>(distance);
            if (!open && outside > 0.0f && 0.5f * outside * outside > candidates.limit()) break;
            if (candidates.perfect()) return;
            distance -= std::max(0, score_near(distance, candidates));
        }
    }

private:
    const Block& block_;
    const Gains& gains_;
    const bool eight_values_;
    const int steps_;
    const int top_;
    const bool open_below_;
    const bool open_above_;
};

// Computes the gains of the outer thresholds at every code of the endpoint.
void tabulate_outer(const Block& block, int top, Gains& gains) {
    const auto gain = [&](float t) {
        float sum = 0.0f;
        float total = 0.0f;
        for (const float v : block.v) {
            sum += std::max(v, t);
            total += v;
        }
        return sum - std::max(total, 16.0f * t);
    };
    for (int e = 0; e <= top; ++e) {
        const float base = static_cast<float>(block.base);
        const float below = static_cast<float>(e);
        const float above = static_cast<float>(top - e);
        gains.below[e] = 2.0f * below * gain(0.5f * below - base);
        gains.above[e] = 2.0f * above * gain(0.5f * static_cast<float>(e + top) - base);
    }
}

Bc4Endpoints search(const BlockTexels& texels, const ClusterBounds& bounds, Bc4Codes codes, Gains& gains) {
    const Block block = measure(texels);
    const int top = codes.top;
    if (block.length == 0) return {block.base, block.base};  // one value, for which a code exists
    Bc4Candidates candidates(block.slack, {texels, codes});
    tabulate(block, 14, gains);
    const Scorer eight(block, gains, true, top, false, false);
    // Start with endpoints at and near the extremes.
    const int distance = std::min(block.length, top);
    eight.score(std::max(0, std::min(block.base - 4, top - distance)), std::min(block.base + 4, top - distance),
                distance, candidates);
    eight.search(bounds, candidates);

    const float s = std::sqrt(candidates.limit());
    const bool open_below = block.least + static_cast<float>(block.base) <= s;
    const bool open_above = static_cast<float>(top - block.base) - block.greatest <= s;
    const int entries = 6 + open_below + open_above;
    if (bounds.bound[entries - 1] <= candidates.limit() && !candidates.perfect()) {
        tabulate(block, 10, gains);
        if (open_below || open_above) tabulate_outer(block, top, gains);
        Scorer(block, gains, false, top, open_below, open_above).search(bounds, candidates);
    }
    return endpoints_of(candidates.settle());
}

void search_bc4_blocks(const BlockTexels* blocks, const ClusterBounds* bounds, int count, Bc4Codes codes,
                       Bc4Endpoints* endpoints) {
    Gains gains;
    for (int k = 0; k < count; ++k) endpoints[k] = search(blocks[k], bounds[k], codes, gains);
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, search_bc4_blocks, search_bc4_blocks,
           (const BlockTexels* blocks, const ClusterBounds* bounds, int count, Bc4Codes codes, Bc4Endpoints* endpoints),
           (blocks, bounds, count, codes, endpoints))

}  // namespace tex::inline v1
#endif  // HWY_ONCE
