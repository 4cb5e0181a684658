// SPDX-License-Identifier: Apache-2.0
// bc7_lines-inl.h: fits texels to lines, by the rules of BC7 or of another format. Include it after
// hwy/highway.h, once for each target.

#if defined(TEX_KERNELS_BC7_LINES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TEX_KERNELS_BC7_LINES_INL_H
#undef TEX_KERNELS_BC7_LINES_INL_H
#else
#define TEX_KERNELS_BC7_LINES_INL_H
#endif

#include <hwy/highway.h>

#include "kernels/bc7_fit.h"
#include "kernels/bc7_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Texels on one line through x, y, z, and alpha with 4 channels.
template <class Rules, int kChannels>
class BlockLineFit {
public:
    HWY_INLINE BlockLineFit(const Bc7Kind& kind, Bc7Group& group) : kind_(kind), group_(group) {
        for (int k = 0; k < group.texels; ++k) {
            for (int c = 0; c < 3; ++c) value_[k][c] = hn::Load(d_, group.value[k][c]);
            if (kChannels == 4) value_[k][3] = hn::Sub(hn::Load(d_, group.value[k][3]), Bc7Number(kBc7Middle));
            weight_[k] = hn::Load(d_, group.weight[k]);
        }
        for (int k = 0; k < 2 * kChannels; ++k)
            best_.at[k / kChannels][k % kChannels] = hn::Load(d_, group.ends[k / kChannels][k % kChannels]);
    }

    HWY_NOINLINE void start();
    HWY_NOINLINE void improve(int rounds, bool pairs);
    HWY_NOINLINE void change_lowest();
    HWY_NOINLINE void finish(bool indices);

private:
    struct Ends {
        FloatVec at[2][kChannels];
    };
    // Where a texel is on the line between endpoints that are relative to the middle, in levels with 1/2 added.
    struct Place {
        FloatVec end[kChannels], range[kChannels];
        FloatVec end_range, range_range;

        HWY_INLINE Place(const FloatVec e0[kChannels], const FloatVec e1[kChannels]) {
            for (int c = 0; c < kChannels; ++c) {
                end[c] = e0[c];
                range[c] = hn::Sub(e1[c], e0[c]);
            }
            end_range = Bc7Dot(end, range);
            range_range = Bc7Dot(range, range);
        }
    };
    HWY_INLINE FloatVec index_of(const Place& place, const FloatVec* value, FloatVec& end_along,
                                 FloatVec& range_along) const;
    HWY_INLINE void ends_of_axis(FloatVec ends[2][kChannels]) const;
    HWY_NOINLINE void fit_lengths(FloatVec ends[2][kChannels]) const;
    HWY_NOINLINE Ends rounded(const FloatVec ends[2][kChannels], FloatVec lowest0, FloatVec lowest1) const;
    HWY_NOINLINE void round(const FloatVec ends[2][kChannels]);
    HWY_NOINLINE FloatVec error_of(const Ends& ends, bool indices);
    HWY_INLINE FloatVec palette_error(const Ends& ends, bool indices);
    HWY_INLINE FloatVec place_error(const Ends& ends, bool indices);
    HWY_INLINE void take_better(const Ends& ends) {
        const FloatVec error = error_of(ends, false);
        const FloatMask better = hn::Lt(error, error_);
        for (int k = 0; k < 2 * kChannels; ++k) {
            FloatVec& end = best_.at[k / kChannels][k % kChannels];
            end = hn::IfThenElse(better, ends.at[k / kChannels][k % kChannels], end);
        }
        error_ = hn::Min(error, error_);
    }

    const FloatTag d_ = {};
    const Bc7Kind& kind_;
    Bc7Group& group_;
    FloatVec value_[16][kChannels];
    FloatVec weight_[16];
    Ends best_;
    FloatVec error_;
};

// The index whose vector is nearest in direction: the point of the line that is nearest to the ray.
template <class Rules, int kChannels>
FloatVec BlockLineFit<Rules, kChannels>::index_of(const Place& place, const FloatVec* value, FloatVec& end_along,
                                                  FloatVec& range_along) const {
    end_along = Bc7Dot(place.end, value);
    range_along = Bc7Dot(place.range, value);
    FloatVec above = hn::Sub(hn::Mul(end_along, range_along), place.end_range);
    FloatVec below = hn::Sub(place.range_range, hn::Mul(range_along, range_along));
    if (kChannels == 4) {
        above = MulThenAdd(hn::Sub(value[3], place.end[3]), place.range[3], above);
        below = MulThenAdd(place.range[3], place.range[3], below);
    }
    const FloatVec last = Bc7Number(static_cast<float>(kind_.levels - 1));
    const FloatVec at = hn::Div(hn::Mul(above, last), hn::Max(below, Bc7Number(1e-3f)));
    return Bc7Index(hn::Add(at, Bc7Number(0.5f)), kind_.levels);
}

// The extremes along the principal axis.
template <class Rules, int kChannels>
void BlockLineFit<Rules, kChannels>::ends_of_axis(FloatVec ends[2][kChannels]) const {
    const FloatVec zero = hn::Zero(d_);
    FloatVec count = zero, mean[kChannels], covariance[kChannels][kChannels];
    for (int c = 0; c < kChannels; ++c) {
        mean[c] = zero;
        for (int e = 0; e < kChannels; ++e) covariance[c][e] = zero;
    }
    // In codes, as alpha is.
    const auto scaled = [&](int k, int c) {
        return c == 3 ? value_[k][c] : hn::Mul(value_[k][c], Bc7Number(kBc7Middle));
    };
    for (int k = 0; k < group_.texels; ++k) {
        count = hn::Add(count, weight_[k]);
        for (int c = 0; c < kChannels; ++c) mean[c] = MulThenAdd(weight_[k], scaled(k, c), mean[c]);
    }
    for (FloatVec& m : mean) m = hn::Div(m, count);
    for (int k = 0; k < group_.texels; ++k) {
        FloatVec off[kChannels];
        for (int c = 0; c < kChannels; ++c) off[c] = hn::Mul(weight_[k], hn::Sub(scaled(k, c), mean[c]));
        for (int c = 0; c < kChannels; ++c) {
            for (int e = 0; e <= c; ++e) covariance[c][e] = MulThenAdd(off[c], off[e], covariance[c][e]);
        }
    }
    for (int c = 0; c < kChannels; ++c) {
        for (int e = 0; e < c; ++e) covariance[e][c] = covariance[c][e];
    }
    // Power iteration from the column of the greatest variance.
    FloatVec axis[kChannels], greatest = covariance[0][0];
    for (int e = 0; e < kChannels; ++e) axis[e] = covariance[0][e];
    for (int c = 1; c < kChannels; ++c) {
        const FloatMask greater = hn::Gt(covariance[c][c], greatest);
        greatest = hn::Max(covariance[c][c], greatest);
        for (int e = 0; e < kChannels; ++e) axis[e] = hn::IfThenElse(greater, covariance[c][e], axis[e]);
    }
    FloatVec squared = zero;
    for (int step = 0; step < 4; ++step) {
        FloatVec next[kChannels], size = Bc7Number(1e-20f);
        for (int c = 0; c < kChannels; ++c) {
            next[c] = hn::Mul(covariance[c][0], axis[0]);
            for (int e = 1; e < kChannels; ++e) next[c] = MulThenAdd(covariance[c][e], axis[e], next[c]);
            size = hn::Max(size, hn::Abs(next[c]));
        }
        squared = Bc7Number(1e-20f);
        for (int c = 0; c < kChannels; ++c) {
            axis[c] = hn::Div(next[c], size);
            squared = MulThenAdd(axis[c], axis[c], squared);
        }
    }
    FloatVec least = Bc7Number(1e9f), most = Bc7Number(-1e9f);
    for (int k = 0; k < group_.texels; ++k) {
        FloatVec along = zero;
        for (int c = 0; c < kChannels; ++c) along = MulThenAdd(hn::Sub(scaled(k, c), mean[c]), axis[c], along);
        along = hn::Div(along, squared);
        const FloatMask counts = hn::Gt(weight_[k], Bc7Number(0.5f));
        least = hn::IfThenElse(counts, hn::Min(least, along), least);
        most = hn::IfThenElse(counts, hn::Max(most, along), most);
    }
    for (int c = 0; c < kChannels; ++c) {
        ends[0][c] = MulThenAdd(least, axis[c], mean[c]);
        ends[1][c] = MulThenAdd(most, axis[c], mean[c]);
    }
}

// Least squares for the present indices and lengths.
template <class Rules, int kChannels>
void BlockLineFit<Rules, kChannels>::fit_lengths(FloatVec ends[2][kChannels]) const {
    const FloatVec zero = hn::Zero(d_), one = Bc7Number(1.0f);
    const FloatVec step = Bc7Number(1.0f / static_cast<float>(kind_.levels - 1));
    const Place place(ends[0], ends[1]);
    FloatVec aa = zero, ab = zero, bb = zero, av[kChannels], bv[kChannels];
    for (int c = 0; c < kChannels; ++c) av[c] = bv[c] = zero;
    for (int k = 0; k < group_.texels; ++k) {
        FloatVec end_along, range_along;
        const FloatVec b = hn::Mul(index_of(place, value_[k], end_along, range_along), step), a = hn::Sub(one, b);
        const FloatVec length = MulThenAdd(b, range_along, end_along);
        const FloatVec wa = hn::Mul(weight_[k], a), wb = hn::Mul(weight_[k], b);
        aa = MulThenAdd(wa, a, aa);
        ab = MulThenAdd(wa, b, ab);
        bb = MulThenAdd(wb, b, bb);
        const FloatVec la = hn::Mul(length, wa), lb = hn::Mul(length, wb);
        for (int c = 0; c < kChannels; ++c) {
            av[c] = MulThenAdd(c == 3 ? wa : la, value_[k][c], av[c]);
            bv[c] = MulThenAdd(c == 3 ? wb : lb, value_[k][c], bv[c]);
        }
    }
    const FloatVec determinant = hn::Sub(hn::Mul(aa, bb), hn::Mul(ab, ab));
    const FloatMask is_line = hn::Gt(determinant, Bc7Number(1e-3f));
    const FloatVec inverse = hn::Div(one, hn::IfThenElse(is_line, determinant, one));
    for (int c = 0; c < kChannels; ++c) {
        const FloatVec e0 = hn::Mul(hn::Sub(hn::Mul(bb, av[c]), hn::Mul(ab, bv[c])), inverse);
        const FloatVec e1 = hn::Mul(hn::Sub(hn::Mul(aa, bv[c]), hn::Mul(ab, av[c])), inverse);
        ends[0][c] = hn::IfThenElse(is_line, e0, ends[0][c]);
        ends[1][c] = hn::IfThenElse(is_line, e1, ends[1][c]);
    }
}

template <class Rules, int kChannels>
auto BlockLineFit<Rules, kChannels>::rounded(const FloatVec ends[2][kChannels], FloatVec lowest0,
                                             FloatVec lowest1) const -> Ends {
    Ends codes;
    for (int c = 0; c < kChannels; ++c) {
        const FloatVec e0 = hn::Add(ends[0][c], Bc7Number(kBc7Middle));
        const FloatVec e1 = hn::Add(ends[1][c], Bc7Number(kBc7Middle));
        const bool none = kind_.lowest == Bc7Lowest::none;
        codes.at[0][c] = none ? Rules::Round(e0, kind_.bits) : Rules::Round(e0, kind_.bits, lowest0);
        codes.at[1][c] = none ? Rules::Round(e1, kind_.bits) : Rules::Round(e1, kind_.bits, lowest1);
    }
    return codes;
}

// Rounds endpoints to codes with the lowest bits that come nearest.
template <class Rules, int kChannels>
void BlockLineFit<Rules, kChannels>::round(const FloatVec ends[2][kChannels]) {
    const FloatVec zero = hn::Zero(d_), one = Bc7Number(1.0f);
    if (kind_.lowest == Bc7Lowest::none || kind_.lowest == Bc7Lowest::ones) {
        best_ = rounded(ends, one, one);
        return;
    }
    const Ends even = rounded(ends, zero, zero), odd = rounded(ends, one, one);
    FloatVec off[2][2] = {{zero, zero}, {zero, zero}};
    for (int e = 0; e < 2; ++e) {
        for (int c = 0; c < kChannels; ++c) {
            const FloatVec wanted = hn::Add(ends[e][c], Bc7Number(kBc7Middle));
            const FloatVec even_off = hn::Sub(Rules::Widen(even.at[e][c], kind_.bits), wanted);
            const FloatVec odd_off = hn::Sub(Rules::Widen(odd.at[e][c], kind_.bits), wanted);
            off[0][e] = MulThenAdd(even_off, even_off, off[0][e]);
            off[1][e] = MulThenAdd(odd_off, odd_off, off[1][e]);
        }
    }
    for (int e = 0; e < 2; ++e) {
        const bool shared = kind_.lowest == Bc7Lowest::shared;
        const FloatMask is_odd = shared ? hn::Lt(hn::Add(off[1][0], off[1][1]), hn::Add(off[0][0], off[0][1]))
                                        : hn::Lt(off[1][e], off[0][e]);
        for (int c = 0; c < kChannels; ++c) best_.at[e][c] = hn::IfThenElse(is_odd, odd.at[e][c], even.at[e][c]);
    }
}

template <class Rules, int kChannels>
FloatVec BlockLineFit<Rules, kChannels>::palette_error(const Ends& ends, bool indices) {
    const int levels = kind_.levels;
    FloatVec palette[8][kChannels];
    for (int c = 0; c < kChannels; ++c) {
        const BlockRamp<Rules> ramp(ends.at[0][c], ends.at[1][c], kind_.bits, levels);
        for (int j = 0; j < levels; ++j) palette[j][c] = ramp.value(Bc7Number(Rules::Weight(j, levels)));
    }
    for (int j = 0; j < levels; ++j) {
        const FloatVec length = hn::Sqrt(Bc7Dot(palette[j], palette[j]));
        const FloatVec inverse = hn::Div(Bc7Number(1.0f), length);
        for (int c = 0; c < 3; ++c) palette[j][c] = hn::Mul(palette[j][c], inverse);
    }
    FloatVec sum = hn::Zero(d_);
    for (int k = 0; k < group_.texels; ++k) {
        FloatVec least = Bc7Number(kBc7None), index = hn::Zero(d_);
        for (int j = 0; j < levels; ++j) {
            FloatVec off[3];
            for (int c = 0; c < 3; ++c) off[c] = hn::Sub(palette[j][c], value_[k][c]);
            FloatVec error = Bc7Dot(off, off);
            if (kChannels == 4)
                error = hn::Add(error, Bc7AlphaError(palette[j][kChannels - 1], value_[k][kChannels - 1]));
            if (indices) {
                const FloatVec number = Bc7Number(static_cast<float>(j));
                index = hn::IfThenElse(hn::Lt(error, least), number, index);
            }
            least = hn::Min(error, least);
        }
        sum = MulThenAdd(least, weight_[k], sum);
        if (indices) hn::Store(index, d_, group_.color[k]);
    }
    return sum;
}

template <class Rules, int kChannels>
FloatVec BlockLineFit<Rules, kChannels>::place_error(const Ends& ends, bool indices) {
    const FloatVec middle = Bc7Number(kBc7Middle);
    FloatVec e0[kChannels], e1[kChannels], step[kChannels], base[kChannels];
    for (int c = 0; c < kChannels; ++c) {
        const FloatVec wide0 = Rules::Widen(ends.at[0][c], kind_.bits), wide1 = Rules::Widen(ends.at[1][c], kind_.bits);
        e0[c] = hn::Sub(wide0, middle);
        e1[c] = hn::Sub(wide1, middle);
        step[c] = hn::Mul(hn::Sub(wide1, wide0), Bc7Number(Rules::kStep));
        base[c] = MulThenAdd(wide0, Bc7Number(Rules::kScale), Bc7Number(Rules::kOffset));
    }
    const Place place(e0, e1);
    FloatVec sum = hn::Zero(d_);
    for (int k = 0; k < group_.texels; ++k) {
        FloatVec end_along, range_along;
        const FloatVec index = index_of(place, value_[k], end_along, range_along);
        const FloatVec weight = Rules::Weight(index, kind_.levels);
        FloatVec vector[kChannels];
        for (int c = 0; c < kChannels; ++c)
            vector[c] = hn::Sub(hn::Floor(MulThenAdd(weight, step[c], base[c])), middle);
        FloatVec error = Bc7Error(vector, value_[k]);
        if (kChannels == 4) error = hn::Add(error, Bc7AlphaError(vector[kChannels - 1], value_[k][kChannels - 1]));
        sum = MulThenAdd(error, weight_[k], sum);
        if (indices) hn::Store(index, d_, group_.color[k]);
    }
    return sum;
}

template <class Rules, int kChannels>
FloatVec BlockLineFit<Rules, kChannels>::error_of(const Ends& ends, bool indices) {
    return kind_.levels > 8 ? place_error(ends, indices) : palette_error(ends, indices);
}

template <class Rules, int kChannels>
void BlockLineFit<Rules, kChannels>::start() {
    FloatVec ends[2][kChannels];
    ends_of_axis(ends);
    for (int step = 0; step < 2; ++step) fit_lengths(ends);
    round(ends);
}

template <class Rules, int kChannels>
void BlockLineFit<Rules, kChannels>::improve(int rounds, bool pairs) {
    if (rounds == 0) return;
    error_ = error_of(best_, false);
    const FloatVec top = Bc7Number(Rules::Top(kind_.bits));
    const float least = kind_.lowest == Bc7Lowest::none ? 1.0f : 2.0f;
    for (int r = 0; r < rounds; ++r) {
        const float stride = Rules::Stride(kind_.bits, pairs ? r : kBc7LateRound), step = least * stride;
        const FloatVec before = error_;
        for (int c = 0; c < kChannels; ++c) {
            for (int move = 0; move < (pairs ? kBc7Moves : 4); ++move) {
                Ends to = best_;
                for (int e = 0; e < 2; ++e) {
                    const FloatVec moved = hn::Add(to.at[e][c], Bc7Number(step * kBc7MoveTable[move][e]));
                    const FloatMask inside = hn::And(hn::Ge(moved, hn::Zero(d_)), hn::Le(moved, top));
                    to.at[e][c] = hn::IfThenElse(inside, moved, to.at[e][c]);
                }
                take_better(to);
            }
        }
        if (pairs) change_lowest();
        if (stride == 1.0f && hn::AllTrue(d_, hn::Ge(error_, before))) break;
    }
}

// Tries the other lowest bit of each endpoint.
template <class Rules, int kChannels>
void BlockLineFit<Rules, kChannels>::change_lowest() {
    const bool shared = kind_.lowest == Bc7Lowest::shared;
    if (!shared && kind_.lowest != Bc7Lowest::own) return;
    for (int first = 0; first < (shared ? 1 : 2); ++first) {
        Ends to = best_;
        for (int e = first; e < (shared ? 2 : first + 1); ++e) {
            for (FloatVec& code : to.at[e]) {
                const FloatVec even = hn::Mul(hn::Floor(hn::Mul(code, Bc7Number(0.5f))), Bc7Number(2.0f));
                code = hn::Sub(hn::Add(hn::Add(even, even), Bc7Number(1.0f)), code);
            }
        }
        take_better(to);
    }
}

template <class Rules, int kChannels>
void BlockLineFit<Rules, kChannels>::finish(bool indices) {
    hn::Store(error_of(best_, indices), d_, group_.error);
    for (int k = 0; k < 2 * kChannels; ++k)
        hn::Store(best_.at[k / kChannels][k % kChannels], d_, group_.ends[k / kChannels][k % kChannels]);
}

template <class Rules, int kChannels>
HWY_INLINE void FitLines(const Bc7Kind& kind, const Bc7Steps& steps, Bc7Group& group) {
    BlockLineFit<Rules, kChannels> fit(kind, group);
    if (steps.starts) fit.start();
    fit.improve(steps.rounds, steps.pairs);
    fit.finish(steps.indices);
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#endif  // once for each target
