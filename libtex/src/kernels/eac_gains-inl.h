// SPDX-License-Identifier: Apache-2.0
// eac_gains-inl.h: the squared errors of EAC palettes with neighbouring bases, from tables of G (see eac_search.h).
//
// Compiled once for each Highway target, as part of eac_search.cpp.

#if defined(TEX_KERNELS_EAC_GAINS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TEX_KERNELS_EAC_GAINS_INL_H
#undef TEX_KERNELS_EAC_GAINS_INL_H
#else
#define TEX_KERNELS_EAC_GAINS_INL_H
#endif

#include <algorithm>
#include <cstddef>

#include <hwy/highway.h>

#include "blocks/eac.h"
#include "kernels/block.h"
#include "kernels/eac_shapes.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, 16>;
using F = hn::Vec<Floats>;

constexpr float scale_of(int multiplier) { return multiplier == 0 ? 0.125f : static_cast<float>(multiplier); }

// Row p of a grid of 1/P holds G(middle + i + p / P), relative to Block::base, from i = -1 on, and zeros on both sides:
// enough for every base and multiplier.
constexpr int kBefore = 496;
constexpr std::ptrdiff_t kRow = kBefore + 256 + 512;
constexpr int kHalfPhases = 2;        // multipliers from 1 on
constexpr int kSixteenthPhases = 16;  // multiplier 0

// Where the gains of a palette's thresholds are in the rows, for a base of 0, by multiplier and table.
struct Places {
    int at[kEacMultipliers][kEacTables][7];
};
constexpr Places kPlaces = [] {
    Places places{};
    for (int multiplier = 0; multiplier < kEacMultipliers; ++multiplier) {
        for (int table = 0; table < kEacTables; ++table) {
            for (int k = 0; k < 7; ++k) {
                const int t = std::max(multiplier, 1) * kEacShapes[static_cast<std::size_t>(table)].sums[k];
                const int phases = multiplier == 0 ? kSixteenthPhases : kHalfPhases;
                const int phase = (t % phases + phases) % phases;
                places.at[multiplier][table][k] = static_cast<int>(phase * kRow) + (t - phase) / phases;
            }
        }
    }
    return places;
}();

class EacGains {
public:
    EacGains() {
        std::fill(std::begin(halves_), std::end(halves_), 0.0f);
        std::fill(std::begin(sixteenths_), std::end(sixteenths_), 0.0f);
    }

    void start(const Block& block, float middle) {
        block_ = &block;
        middle_ = middle;
        has_sixteenths_ = false;
        tabulate(kHalfPhases, halves_dirty_, halves_);
    }

    // To be called before errors() for this multiplier.
    void prepare(int multiplier) {
        if (multiplier != 0 || has_sixteenths_) return;
        has_sixteenths_ = true;
        tabulate(kSixteenthPhases, sixteenths_dirty_, sixteenths_);
    }

    // The errors for the bases lower, lower + 1 and so on, one in each lane.
    HWY_INLINE F errors(int table, int multiplier, int lower) const {
        const Floats d;
        const float scale = scale_of(multiplier);
        const EacShape& shape = kEacShapes[static_cast<std::size_t>(table)];
        const int* places = kPlaces.at[multiplier][table];
        const int offset = lower - block_->base;
        const float* from = (multiplier == 0 ? sixteenths_ : halves_) + kBefore + offset;
        F gain = hn::Mul(hn::LoadU(d, from + places[0]), hn::Set(d, shape.gaps[0]));
        for (int k = 1; k < 7; ++k)
            gain = hn::Add(gain, hn::Mul(hn::LoadU(d, from + places[k]), hn::Set(d, shape.gaps[k])));
        const F low = hn::Add(hn::Iota(d, 0.0f), hn::Set(d, static_cast<float>(offset)));
        const F mean = hn::Set(d, block_->mean - middle_ + 0.5f * scale);
        const F u = hn::Abs(hn::Sub(mean, low));  // from the middle of the palette
        const F scales = hn::Set(d, scale);
        F away = hn::Abs(hn::Sub(u, hn::Mul(scales, hn::Set(d, shape.halves[0]))));
        for (int k = 1; k < 4; ++k)
            away = hn::Min(away, hn::Abs(hn::Sub(u, hn::Mul(scales, hn::Set(d, shape.halves[k])))));
        return hn::Sub(hn::Add(hn::Set(d, block_->deviations), hn::Mul(hn::Set(d, block_->count), hn::Mul(away, away))),
                       hn::Mul(hn::Add(scales, scales), gain));
    }

private:
    // Entries up to `dirty` are left over from other blocks.
    void tabulate(int phases, int& dirty, float* rows) const {
        const Floats d;
        const int lanes = static_cast<int>(hn::Lanes(d));
        F v[16];
        F total = hn::Zero(d);
        int last = 0;
        for (int k = 0; k < 16; ++k) {
            v[k] = hn::Set(d, block_->v[k]);
            total = hn::Add(total, v[k]);
        }
        for (int p = 0; p < phases; ++p) {
            float* row = rows + p * kRow + kBefore;
            const float first = middle_ + static_cast<float>(p) / static_cast<float>(phases);
            int i = -1;
            for (; i <= block_->length; i += lanes) {
                const F t = hn::Add(hn::Iota(d, 0.0f), hn::Set(d, first + static_cast<float>(i)));
                F sum = hn::Max(v[0], t);
                for (int k = 1; k < 16; ++k) sum = hn::Add(sum, hn::Max(v[k], t));
                hn::StoreU(hn::Sub(sum, hn::Max(total, hn::Mul(t, hn::Set(d, 16.0f)))), d, row + i);
            }
            last = i;
            for (; i < dirty; i += lanes) hn::StoreU(hn::Zero(d), d, row + i);
        }
        dirty = last;
    }

    HWY_ALIGN float halves_[kHalfPhases * kRow];
    HWY_ALIGN float sixteenths_[kSixteenthPhases * kRow];
    const Block* block_ = nullptr;
    float middle_ = 0.0f;
    int halves_dirty_ = 0;
    int sixteenths_dirty_ = 0;
    bool has_sixteenths_ = false;
};

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#endif
