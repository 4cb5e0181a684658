// SPDX-License-Identifier: Apache-2.0

#include "kernels/eac_search.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "kernels/block.h"
#include "kernels/candidates.h"
#include "kernels/eac_shapes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/eac_search.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/dispatch.h"
#include "kernels/eac_gains-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

using Ints = hn::Rebind<std::int32_t, Floats>;

// For each texel, 8 times the distance to the nearest code of the palette plus its selector, the first of equally near
// ones.
HWY_INLINE void find_nearest(const BlockTexels& texels, EacCodes codes, EacPalette palette, std::int32_t* nearest) {
    const Ints d;
    const auto lowest = hn::Set(d, 0);
    const auto greatest = hn::Set(d, codes.top * kEacUnit);
    const int middle = (8 * palette.base + codes.middle) * kEacUnit;
    const int scale = (palette.multiplier == 0 ? 1 : 8 * palette.multiplier) * kEacUnit;
    for (int i = 0; i < 16; i += static_cast<int>(hn::Lanes(d))) {
        const auto values = hn::LoadU(d, texels.values + i);
        auto least = hn::Set(d, 1 << 30);
        for (int k = 0; k < 8; ++k) {
            const auto code =
                hn::Min(hn::Max(hn::Set(d, middle + scale * kEacModifiers[palette.table][k]), lowest), greatest);
            const auto distance = hn::ShiftLeft<3>(hn::Abs(hn::Sub(values, code)));
            least = hn::Min(least, hn::Or(distance, hn::Set(d, k)));
        }
        hn::StoreU(least, d, nearest + i);
    }
}

// A palette as a candidate: the base is `lower`, the multiplier `distance` and the table `kind`.
EacPalette eac_palette_of(const Candidate& c) { return {c.lower, c.distance, c.kind}; }

struct ExactEacError {
    const BlockTexels& texels;
    EacCodes codes;
    // The squared error of the block, in units of (code / kEacUnit)^2.
    std::int64_t operator()(const Candidate& c) const {
        std::int32_t nearest[16];
        find_nearest(texels, codes, eac_palette_of(c), nearest);
        std::int64_t sum = 0;
        for (int k = 0; k < 16; ++k) {
            const std::int64_t distance = texels.mask >> k & 1 ? nearest[k] >> 3 : 0;
            sum += distance * distance;
        }
        return sum;
    }
};

using EacCandidates = Candidates<ExactEacError>;

// Bases from `first` to `last`.
struct Bases {
    int first, last;
    [[nodiscard]] bool empty() const { return first > last; }
    [[nodiscard]] Bases within(Bases other) const { return {std::max(first, other.first), std::min(last, other.last)}; }
};

// A code nearest to the value of a block with a single one, as a palette of multiplier 0.
EacPalette single_palette(const BlockTexels& texels, EacCodes codes) {
    const int code = std::min((texels.values[0] + kEacUnit / 2) / kEacUnit, codes.top);
    for (int table = 0; table < kEacTables; ++table) {
        for (const int modifier : kEacModifiers[table]) {
            const int from = code - codes.middle - modifier;
            if (from >= 0 && from % 8 == 0 && from / 8 < codes.bases) return {from / 8, 0, table};
        }
    }
    return {};  // not reached: the modifiers have all remainders, near both ends too
}

class EacSearch {
public:
    EacSearch(const BlockTexels& texels, const ClusterBounds& bounds, EacCodes codes, EacGains& gains)
        : block_(measure(texels)), bounds_(bounds), codes_(codes), gains_(gains),
          middle_(static_cast<float>(codes.middle) * 0.125f), top_(static_cast<float>(codes.top) * 0.125f),
          range_(block_.greatest - block_.least), candidates_(slack(texels), {texels, codes}) {
        gains_.start(block_, middle_);
    }

    EacPalette best() {
        candidates_.add(near());
        const float reach = std::sqrt(candidates_.limit()) * 1.00001f + 1e-4f;
        open_below_ = block_.least + static_cast<float>(block_.base) <= reach;
        open_above_ = top_ - static_cast<float>(block_.base) - block_.greatest <= reach;
        const int start = multipliers().first;
        for (int multiplier = start; multiplier < kEacMultipliers; ++multiplier) {
            if (candidates_.perfect() || !try_multiplier(multiplier)) break;
        }
        for (int multiplier = start - 1; multiplier >= 0; --multiplier) {
            if (candidates_.perfect()) break;
            try_multiplier(multiplier);
        }
        return eac_palette_of(candidates_.settle());
    }

    // The best of the palettes that stand near the middle of the block's range and whose multipliers suit the range.
    // Clamping is ignored.
    Candidate near() {
        const Floats d;
        const int lanes = static_cast<int>(hn::Lanes(d));
        const auto [first_multiplier, last_multiplier] = multipliers();
        const int bases = range_ < 80.0f ? 16 : 32;
        const float middle = 0.5f * (block_.least + block_.greatest) - middle_ + 0.5f;
        const int base = block_.base + static_cast<int>(std::floor(middle + 0.5f));
        Candidate best{1e30f, 0, 0, 0};
        gains_.prepare(range_ < 6.0f ? 0 : 1);
        for (int part = 0; part < bases; part += lanes) {
            F least = hn::Set(d, 1e30f);
            F which = hn::Zero(d);  // 16 multiplier + table
            const auto try_table = [&](int table, int multiplier) {
                const int lower = first_base(base, multiplier, bases) + part;
                const F error = gains_.errors(table, multiplier, lower);
                which = hn::IfThenElse(hn::Lt(error, least), hn::Set(d, static_cast<float>(16 * multiplier + table)),
                                       which);
                least = hn::Min(error, least);
            };
            for (int multiplier = first_multiplier; multiplier <= last_multiplier; ++multiplier) {
                for (int table = 0; table < kEacTables; ++table) try_table(table, multiplier);
            }
            if (range_ >= 4.0f && range_ < 6.0f) try_table(kWide, 0);
            if (range_ >= 6.0f && range_ < 12.0f) try_table(kDense, 2);
            HWY_ALIGN float errors[16], numbers[16];
            hn::Store(least, d, errors);
            hn::Store(which, d, numbers);
            for (int lane = 0; lane < lanes; ++lane) {
                const int number = static_cast<int>(numbers[lane]);
                const Candidate found{errors[lane], first_base(base, number / 16, bases) + part + lane, number / 16,
                                      number % 16};
                if (found.error < best.error) best = found;
            }
        }
        return best;
    }

private:
    // Bounds the rounding of errors. Texels outside the level are replaced by the mean, which is rounded.
    [[nodiscard]] float slack(const BlockTexels& texels) const {
        return (texels.mask == 0xFFFF ? 1e-5f : 1e-4f) * range_ * range_ + 1e-6f;
    }

    static constexpr int kWide = 0;    // the table with the greatest modifiers
    static constexpr int kDense = 13;  // the table with six entries at distances of 1

    // The first of the bases that near() tries, around the middle of the range.
    [[nodiscard]] int first_base(int base, int multiplier, int bases) const {
        return std::clamp(base + multiplier / 2 - bases / 2, 0, codes_.bases - bases);
    }

    // The multipliers whose palettes are about as wide as the block's range.
    struct Multipliers {
        int first, last;
    };
    [[nodiscard]] Multipliers multipliers() const {
        if (range_ < 4.0f) return {0, 1};
        const int first = std::max(1, static_cast<int>((range_ + 8.0f) * (1.0f / 26.0f)));
        return {first, std::clamp(static_cast<int>(range_ * (1.0f / 14.0f)), first, kEacMultipliers - 1)};
    }

    // How many entries a palette needs to come below the limit.
    [[nodiscard]] int least_entries() const {
        int n = 1;
        while (n < kMaxClusters && bounds_.bound[n - 1] > candidates_.limit()) ++n;
        return n;
    }

    // Returns false if no greater multiplier can hold the best palette.
    bool try_multiplier(int multiplier) {
        gains_.prepare(multiplier);
        const float scale = scale_of(multiplier);
        const float limit = std::max(candidates_.limit(), 0.0f);
        const float reach = std::sqrt(limit) * 1.00001f + 1e-4f;  // rounded up
        const bool open = open_below_ || open_above_;
        const int thresholds = std::max(multiplier == 0 ? 1 : 2, least_entries()) - 1;
        // A clamped entry may take the place of one threshold on its side.
        const int unclamped = std::max(thresholds - (open_below_ ? 1 : 0) - (open_above_ ? 1 : 0), 0);
        bool fits = false;
        for (int table = 0; table < kEacTables; ++table) {
            const EacShape& shape = kEacShapes[static_cast<std::size_t>(table)];
            const float lowest = middle_ + scale * static_cast<float>(shape.lowest);
            const float greatest = middle_ + scale * static_cast<float>(shape.greatest);
            const float short_by = range_ - (greatest - lowest);
            Bases bases = window(table, scale, thresholds, limit, fits);
            if (short_by > 0.0f && 0.5f * short_by * short_by > limit) continue;
            const Bases all = bases_near(block_.greatest - reach - greatest, block_.least + reach - lowest);
            if (open) {
                // Bases whose entries are clamped.
                const int below = open_below_ ? static_cast<int>(std::ceil(-lowest)) - 1 : -1;
                const int above = open_above_ ? static_cast<int>(std::floor(top_ - greatest)) + 1 : codes_.bases;
                const Bases some = window(table, scale, unclamped, 1e30f, fits);
                score_clamped(table, multiplier, all.within(some).within({0, below}));
                score_clamped(table, multiplier, all.within(some).within({std::max(below + 1, above), codes_.bases}));
                bases = bases.within({below + 1, above - 1});
            }
            score(table, multiplier, all.within(bases));
        }
        return fits;
    }

    // Bases for which this many neighbouring thresholds may lie within the block's range. Sets `fits` if the range is
    // wide enough for them.
    [[nodiscard]] Bases window(int table, float scale, int thresholds, float limit, bool& fits) const {
        fits = fits || thresholds == 0;
        if (thresholds == 0) return {0, codes_.bases - 1};
        // How far thresholds may be apart, in sums; or the two entries of a single one.
        const float apart = 2.0f * range_ + (thresholds == 1 ? 2.0f * std::sqrt(limit / block_.count) : 0.0f);
        const EacWindow& window =
            eac_window(table, thresholds, static_cast<int>(std::min(apart / scale + 0.01f, 999.0f)));
        if (window.empty()) return {0, -1};
        fits = true;
        return bases_near(block_.least - middle_ - 0.5f * scale * static_cast<float>(window.first),
                          block_.greatest - middle_ - 0.5f * scale * static_cast<float>(window.last));
    }

    // Bases in an interval relative to Block::base, rounded outwards.
    [[nodiscard]] Bases bases_near(float first, float last) const {
        first = std::max(first, -600.0f);
        last = std::min(last, 600.0f);
        return Bases{block_.base + static_cast<int>(std::ceil(first - 1e-3f)),
                     block_.base + static_cast<int>(std::floor(last + 1e-3f))}
            .within({0, codes_.bases - 1});
    }

    void score(int table, int multiplier, Bases bases) {
        const int lanes = static_cast<int>(hn::Lanes(Floats()));
        for (int lower = bases.first; lower <= bases.last; lower += lanes)
            add(table, multiplier, lower, bases.last, gains_.errors(table, multiplier, lower));
    }

    // Scores without tables, for palettes with entries that are clamped.
    void score_clamped(int table, int multiplier, Bases bases) {
        const Floats d;
        const int lanes = static_cast<int>(hn::Lanes(d));
        const float scale = scale_of(multiplier);
        const F lowest = hn::Set(d, -static_cast<float>(block_.base));
        const F greatest = hn::Set(d, top_ - static_cast<float>(block_.base));
        F total = hn::Zero(d);
        for (int k = 0; k < 16; ++k) total = hn::Add(total, hn::Set(d, block_.v[k]));
        for (int lower = bases.first; lower <= bases.last; lower += lanes) {
            const F base = hn::Add(hn::Iota(d, 0.0f), hn::Set(d, static_cast<float>(lower - block_.base) + middle_));
            const auto entry = [&](int k) {
                constexpr int kAscending[8] = {3, 2, 1, 0, 4, 5, 6, 7};
                const float modifier = static_cast<float>(kEacModifiers[table][kAscending[k]]);
                return hn::Min(hn::Max(hn::Add(base, hn::Set(d, scale * modifier)), lowest), greatest);
            };
            F before = entry(0);
            F away = hn::Abs(hn::Sub(hn::Set(d, block_.mean), before));
            F gain = hn::Zero(d);
            for (int k = 1; k < 8; ++k) {
                const F value = entry(k);
                const F t = hn::Mul(hn::Add(before, value), hn::Set(d, 0.5f));
                F sum = hn::Max(hn::Set(d, block_.v[0]), t);
                for (int j = 1; j < 16; ++j) sum = hn::Add(sum, hn::Max(hn::Set(d, block_.v[j]), t));
                const F g = hn::Sub(sum, hn::Max(total, hn::Mul(t, hn::Set(d, 16.0f))));
                gain = hn::Add(gain, hn::Mul(hn::Sub(value, before), g));
                away = hn::Min(away, hn::Abs(hn::Sub(hn::Set(d, block_.mean), value)));
                before = value;
            }
            const F outside = hn::Mul(hn::Set(d, block_.count), hn::Mul(away, away));
            add(table, multiplier, lower, bases.last,
                hn::Sub(hn::Add(hn::Set(d, block_.deviations), outside), hn::Add(gain, gain)));
        }
    }

    // Adds the palettes with bases from `lower` to `last`, as many as there are lanes, that may be the best.
    HWY_INLINE void add(int table, int multiplier, int lower, int last, F error) {
        const Floats d;
        const int lanes = static_cast<int>(hn::Lanes(d));
        const auto valid = hn::Lt(hn::Iota(d, 0.0f), hn::Set(d, static_cast<float>(last - lower + 1)));
        if (hn::AllFalse(d, hn::And(valid, hn::Le(error, hn::Set(d, candidates_.limit()))))) return;
        HWY_ALIGN float errors[16];
        hn::Store(error, d, errors);
        for (int lane = 0; lane < std::min(lanes, last - lower + 1); ++lane) {
            candidates_.add({errors[lane], lower + lane, multiplier, table});
        }
    }

    const Block block_;
    const ClusterBounds& bounds_;
    const EacCodes codes_;
    EacGains& gains_;
    const float middle_, top_;
    const float range_;
    bool open_below_ = false, open_above_ = false;
    EacCandidates candidates_;
};

void EncodeEacBlocks(const BlockTexels* texels, const ClusterBounds* bounds, int count, EacCodes codes, Effort effort,
                     std::byte* blocks) {
    EacGains gains;
    for (int k = 0; k < count; ++k, blocks += 16) {
        std::int32_t nearest[16];
        EacPalette palette;
        const auto [least, greatest] = std::minmax_element(texels[k].values, texels[k].values + 16);
        if (*least == *greatest) {
            palette = single_palette(texels[k], codes);
        } else {
            EacSearch search(texels[k], bounds[k], codes, gains);
            palette = effort == Effort::best ? search.best() : eac_palette_of(search.near());
        }
        find_nearest(texels[k], codes, palette, nearest);
        write_eac(codes, palette, nearest, blocks);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, encode_eac_blocks, EncodeEacBlocks,
           (const BlockTexels* texels, const ClusterBounds* bounds, int count, EacCodes codes, Effort effort,
            std::byte* blocks),
           (texels, bounds, count, codes, effort, blocks))

}  // namespace tex::inline v1
#endif  // HWY_ONCE
