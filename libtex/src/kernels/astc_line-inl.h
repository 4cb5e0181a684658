// SPDX-License-Identifier: Apache-2.0
// astc_line-inl.h: blocks side by side, of which one set of weights interpolates one or two channels, in one partition
// or in up to three. Include it after hwy/highway.h, once for each target.

#if defined(TEX_KERNELS_ASTC_LINE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TEX_KERNELS_ASTC_LINE_INL_H
#undef TEX_KERNELS_ASTC_LINE_INL_H
#else
#define TEX_KERNELS_ASTC_LINE_INL_H
#endif

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include "kernels/astc_fit.h"
#include "kernels/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using AstcFloat = FloatVec;

// Decoding rounds down, by half of a step of halves in the mean; so what is to come back is that much greater.
inline constexpr float kAstcRoundedDown = 1.0003f;

template <int kChannels, int kPartitions>
struct AstcEnds {
    AstcFloat at[kPartitions][kChannels][2];
};

template <int kChannels, int kPartitions>
struct AstcBest {
    AstcFloat error;
    AstcEnds<kChannels, kPartitions> ends;
    alignas(64) float weights[kAstcMostWeights * kAstcLanes];
};

// The endpoints that blocks of a plan can store, by partition. The same code serves lines of all templates.
class AstcRounding {
protected:
    AstcRounding(const AstcPlan& plan, const float* offset, int partitions) : plan_(plan) {
        for (int p = 0; p < partitions; ++p) {
            offset_[p] = hn::Load(d_, offset + at(p));
            const auto has_offset = hn::Gt(offset_[p], number(0.5f));
            use_[p] = hn::AllFalse(d_, has_offset) ? kNoOffsets : hn::AllTrue(d_, has_offset) ? kOffsets : kBoth;
        }
    }

    HWY_INLINE std::size_t at(int k) const { return static_cast<std::size_t>(k) * hn::Lanes(d_); }
    HWY_INLINE AstcFloat number(float value) const { return hn::Set(d_, value); }

    // The element of a table of floats that stands at a value, rounded.
    HWY_INLINE AstcFloat look_up(const float* table, AstcFloat place) const {
        const hn::RebindToSigned<FloatTag> di;
        return hn::GatherIndex(d_, table, hn::ConvertTo(di, hn::Add(place, number(0.5f))));
    }

    // Selects the value for endpoints with offsets or for others, as the blocks of a partition use them.
    HWY_INLINE AstcFloat by_use(int p, AstcFloat offsets, AstcFloat others) const {
        return hn::IfThenElse(hn::Gt(offset_[p], number(0.5f)), offsets, others);
    }

    // Over the texels of a partition: their number, and sums of weights, squares, values and products.
    struct Sums {
        AstcFloat n, w, ww, v, wv;
    };

    AstcFloat first_end(int p, AstcFloat end, int way) const;
    AstcFloat second_end(int p, AstcFloat first, AstcFloat end, int way) const;
    void nearest_pair(int p, const Sums& s, AstcFloat end[2]) const;

    const FloatTag d_;
    const AstcPlan& plan_;
    AstcFloat offset_[3];
    enum Use { kNoOffsets, kOffsets, kBoth } use_[3];  // of all blocks
};

template <int kChannels, int kPartitions>
class AstcLine : AstcRounding {
public:
    using Ends = AstcEnds<kChannels, kPartitions>;

    AstcLine(const AstcPlan& plan, const AstcSteps& steps, const AstcGroup& group, const float* v0, const float* v1)
        : AstcRounding(plan, group.offset, kPartitions == 1 ? 1 : plan.partitions), steps_(steps),
          partition_(group.partition), turn_(group.turn), value_{v0, v1} {
        best_.error = hn::Set(d_, 1e30f);
    }

    [[nodiscard]] const AstcBest<kChannels, kPartitions>& best() const { return best_; }
    // One, or as many as the plan has: code for each number would take too much room.
    [[nodiscard]] HWY_INLINE int partitions() const { return kPartitions == 1 ? 1 : plan_.partitions; }

    void fit() {
        Ends starts[kMostStarts];
        make_starts(starts);
        for (int k = 0; k < steps_.starts; ++k) {
            Ends ends = starts[k];
            for (int n = 0; n < steps_.iterations; ++n) {
                make_weights(ends, n > 0 && steps_.sweeps == 1 ? grid_ : nullptr);
                make_ends(ends);
                keep(ends);
            }
        }
        for (int n = 0; n < steps_.polishes && polish(); ++n) {
        }
    }

private:
    static constexpr int kMostStarts = 2;
    HWY_INLINE AstcFloat texel(int c, int k) const { return hn::Load(d_, value_[c] + at(k)); }

    // Selects the value of a texel's partition.
    template <class Value>
    HWY_INLINE AstcFloat of_texel(int k, Value value) const {
        AstcFloat result = value(0);
        for (int p = 1; p < partitions(); ++p) {
            const AstcFloat partition = hn::Load(d_, partition_ + at(k));
            result = hn::IfThenElse(hn::Gt(partition, number(static_cast<float>(p) - 0.5f)), value(p), result);
        }
        return result;
    }

    // Selects one value for texels of partition p, and another for the rest.
    HWY_INLINE AstcFloat of_partition(int p, int k, AstcFloat value, AstcFloat other) const {
        const AstcFloat partition = hn::Load(d_, partition_ + at(k));
        return hn::IfThenElse(hn::Eq(partition, number(static_cast<float>(p))), value, other);
    }

    AstcFloat in_partition(int p, int k) const;
    Ends outer_ends() const;
    void outer_ends_of_two(int p, Ends& ends) const;
    void make_starts(Ends* starts);
    void try_starts(int p, AstcFloat best[2][2]) const;
    void make_ideal(const Ends& ends);
    void make_weights(const Ends& ends, const float* near);
    void round_grid(const float* near);
    void change_weight(int w, bool rounds);
    void make_ends(Ends& ends) const;
    bool keep(const Ends& ends);
    bool polish();
    AstcFloat error_of(const Ends& ends) const;

    const AstcSteps& steps_;
    const float* const partition_;
    const float* const turn_;
    const float* const value_[2];
    AstcBest<kChannels, kPartitions> best_;
    alignas(64) float ideal_[kAstcMostPlanned * kAstcLanes];   // weights of texels, and what the grid leaves of them
    alignas(64) float square_[kAstcMostPlanned * kAstcLanes];  // of the distance of the endpoints of a texel
    alignas(64) float grid_[kAstcMostWeights * kAstcLanes];    // 0 to 64
    alignas(64) float weight_[kAstcMostPlanned * kAstcLanes];  // of texels, as the decoder makes them: 0 to 64
};

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#endif  // TEX_KERNELS_ASTC_LINE_INL_H
