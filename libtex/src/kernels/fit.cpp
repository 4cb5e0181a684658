// SPDX-License-Identifier: Apache-2.0

#include "kernels/fit.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "kernels/single_greens.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/fit.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/fit_exact-inl.h"
#include "kernels/fit_group-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tex {
namespace HWY_NAMESPACE {

// The alpha of BC3, the channels of BC5: 8 values, endpoints of 8 bits.
struct Bc4Kind {
    static constexpr int kSteps = 7;
    float top;

    // Rounds endpoints in codes to what the block can hold.
    HWY_INLINE void round(F& low, F& high) const {
        const F most = constant(top);
        const F half = constant(0.5f);
        const F a = hn::Min(hn::Max(hn::Floor(hn::Add(low, half)), hn::Zero(Floats())), most);
        const F b = hn::Min(hn::Max(hn::Floor(hn::Add(high, half)), hn::Zero(Floats())), most);
        // Equal ones would mean 6 values: take the codes on both sides.
        const F floor = hn::Min(hn::Max(hn::Floor(low), hn::Zero(Floats())), constant(top - 1.0f));
        const auto apart = hn::Gt(b, a);
        low = hn::IfThenElse(apart, a, floor);
        high = hn::IfThenElse(apart, b, hn::Add(floor, constant(1.0f)));
    }
    // The codes of 8 bits that the decoder makes of them.
    HWY_INLINE F widen(F code) const { return code; }
};

// DXT5nm's green: 4 values, endpoints of 6 bits.
struct GreenKind {
    static constexpr int kSteps = 3;

    HWY_INLINE void round(F& low, F& high) const {
        const F most = constant(63.0f);
        const F half = constant(0.5f);
        const F scale = constant(63.0f / 255.0f);
        const F a = hn::Min(hn::Max(hn::Floor(hn::Add(hn::Mul(low, scale), half)), hn::Zero(Floats())), most);
        const F b = hn::Min(hn::Max(hn::Floor(hn::Add(hn::Mul(high, scale), half)), hn::Zero(Floats())), most);
        low = hn::Min(a, b);
        high = hn::Max(a, b);
    }
    HWY_INLINE F widen(F code) const {
        return hn::Add(hn::Mul(code, constant(4.0f)), hn::Floor(hn::Mul(code, constant(1.0f / 16.0f))));
    }
};

// The ramp of local endpoints a <= b.
template <class Kind>
HWY_INLINE void store_ramp(F a, F b, int i, Ramp& ramp) {
    const Floats d;
    const F span = hn::Sub(b, a);
    // At most 65535: a span below 2 n units is that of a block of nearly one value.
    const F exact = hn::Div(constant(131072.0f * static_cast<float>(Kind::kSteps)), hn::Max(span, constant(2.001f * static_cast<float>(Kind::kSteps))));
    const F factor = hn::IfThenElseZero(hn::Gt(span, hn::Zero(d)), exact);
    const F zero_at = hn::Mul(hn::Mul(hn::Add(a, constant(kBias)), factor), constant(1.0f / 1024.0f));
    store_words(factor, ramp.factor + i);
    store_words(hn::Min(hn::Max(hn::Sub(zero_at, constant(63.5f)), hn::Zero(d)), constant(65535.0f)), ramp.subtract + i);
}

template <class Kind>
HWY_INLINE W index(const Group& group, int texel, W factor, W subtract) {
    const Words d;
    const W scaled = hn::MulHigh(hn::Load(d, group.scaled + texel * lanes()), factor);
    const W k = hn::ShiftRight<7>(hn::SaturatedSub(scaled, subtract));
    return hn::Min(k, hn::Set(d, static_cast<std::uint16_t>(Kind::kSteps)));
}

template <class Kind>
HWY_INLINE void sum_up(const Group& group, const Ramp& ramp, Sums& sums) {
    const Words d;
    const W factor = hn::Load(d, ramp.factor);
    const W subtract = hn::Load(d, ramp.subtract);
    W sum_k = hn::Zero(d);
    W sum_kk = hn::Zero(d);
    W sum_kv = hn::Zero(d);
    for (int texel = 0; texel < 16; ++texel) {
        const W k = index<Kind>(group, texel, factor, subtract);
        const W value = hn::Load(d, group.values + texel * lanes());
        sum_k = hn::Add(sum_k, k);
        sum_kk = hn::Add(sum_kk, hn::Mul(k, k));
        sum_kv = hn::Add(sum_kv, hn::Mul(k, value));
    }
    hn::Store(sum_k, d, sums.k);
    hn::Store(sum_kk, d, sums.kk);
    hn::Store(sum_kv, d, sums.kv);
}

// Endpoints in codes on their way, for each block.
struct Ends {
    HWY_ALIGN float low[kLanes], high[kLanes];
};

template <class Kind>
class Fitter {
public:
    Fitter(Group& group, Kind kind) : group_(group), kind_(kind) {}

    // Rounds the endpoints, scores them, keeps them where they are the best so far; with `refined` replaces them by those that
    // suit the indices best.
    void step(Ends& ends, bool refined) {
        const Floats d;
        const int width = static_cast<int>(hn::Lanes(d));
        Ramp ramp;
        Ends rounded;
        for (int i = 0; i < lanes(); i += width) {
            F low = hn::Load(d, ends.low + i);
            F high = hn::Load(d, ends.high + i);
            kind_.round(low, high);
            hn::Store(low, d, rounded.low + i);
            hn::Store(high, d, rounded.high + i);
            store_ramp<Kind>(local(low, i), local(high, i), i, ramp);
        }
        score(rounded, ramp, refined ? &ends : nullptr);
    }

    // Starts from (g, j) and takes `steps` steps.
    void start(float g, float j, int steps) {
        const Floats d;
        Ends ends;
        for (int i = 0; i < lanes(); i += static_cast<int>(hn::Lanes(d))) {
            const F least = hn::Load(d, group_.least + i);
            const F range = hn::Sub(hn::Load(d, group_.greatest + i), least);
            const F spacing = hn::Mul(range, constant(1.0f / (static_cast<float>(Kind::kSteps) - j + g)));
            const F a = hn::Add(least, hn::Mul(spacing, constant(0.5f * g)));
            const F b = hn::Add(a, hn::Mul(spacing, constant(static_cast<float>(Kind::kSteps))));
            hn::Store(code(a, i), d, ends.low + i);
            hn::Store(code(b, i), d, ends.high + i);
        }
        for (int k = 0; k < steps; ++k) step(ends, k + 1 < steps);
    }

    // Endpoints at the extremes, moved inwards by a part of the range, then those that suit their indices best, not scored.
    HWY_INLINE void solve(float part) {
        const Floats d;
        Ends ends;
        Ramp ramp;
        for (int i = 0; i < lanes(); i += static_cast<int>(hn::Lanes(d))) {
            const F least = hn::Load(d, group_.least + i);
            const F greatest = hn::Load(d, group_.greatest + i);
            const F inset = hn::Mul(hn::Sub(greatest, least), constant(part));
            const F a = hn::Add(least, inset);
            const F b = hn::Sub(greatest, inset);
            hn::Store(code(a, i), d, ends.low + i);
            hn::Store(code(b, i), d, ends.high + i);
            store_ramp<Kind>(a, b, i, ramp);
        }
        Sums sums;
        sum_up<Kind>(group_, ramp, sums);
        for (int i = 0; i < lanes(); i += static_cast<int>(hn::Lanes(d))) {
            refine(sums, i, ends);
            F low = hn::Load(d, ends.low + i);
            F high = hn::Load(d, ends.high + i);
            kind_.round(low, high);
            hn::Store(low, d, group_.low + i);
            hn::Store(high, d, group_.high + i);
        }
    }

    // Scores all pairs of stored codes whose members are within `reach` of the best.
    void neighbours(int reach, float most) {
        const Floats d;
        Ends center;
        std::memcpy(center.low, group_.low, sizeof center.low);
        std::memcpy(center.high, group_.high, sizeof center.high);
        for (int p = -reach; p <= reach; ++p) {
            for (int q = -reach; q <= reach; ++q) {
                if (p == 0 && q == 0) continue;
                Ends moved;
                Ramp ramp;
                for (int i = 0; i < lanes(); i += static_cast<int>(hn::Lanes(d))) {
                    const F top = constant(most);
                    const F low = hn::Min(hn::Max(hn::Add(hn::Load(d, center.low + i), constant(static_cast<float>(p))), hn::Zero(d)), top);
                    const F high = hn::Min(hn::Max(hn::Add(hn::Load(d, center.high + i), constant(static_cast<float>(q))), low), top);
                    hn::Store(low, d, moved.low + i);
                    hn::Store(high, d, moved.high + i);
                    store_ramp<Kind>(local(low, i), local(high, i), i, ramp);
                }
                score(moved, ramp, nullptr);
            }
        }
    }

    // The indices of the best endpoints.
    void best_ramp(Ramp& ramp) const {
        const Floats d;
        for (int i = 0; i < lanes(); i += static_cast<int>(hn::Lanes(d))) {
            store_ramp<Kind>(local(hn::Load(d, group_.low + i), i), local(hn::Load(d, group_.high + i), i), i, ramp);
        }
    }

private:
    HWY_INLINE F code(F value, int i) const {
        const Floats d;
        return hn::Add(hn::Load(d, group_.base + i), hn::Mul(value, hn::Load(d, group_.unit + i)));
    }
    // The stored code as a local value.
    HWY_INLINE F local(F stored, int i) const {
        const Floats d;
        return hn::Mul(hn::Sub(kind_.widen(stored), hn::Load(d, group_.base + i)), hn::Load(d, group_.per_unit + i));
    }

    void score(const Ends& rounded, const Ramp& ramp, Ends* refined) {
        const Floats d;
        const hn::Rebind<std::uint16_t, Floats> dw;
        const hn::Rebind<std::int32_t, Floats> di;
        Sums sums;
        sum_up<Kind>(group_, ramp, sums);
        for (int i = 0; i < lanes(); i += static_cast<int>(hn::Lanes(d))) {
            const auto get = [&](const std::uint16_t* row) { return hn::ConvertTo(d, hn::PromoteTo(di, hn::Load(dw, row + i))); };
            const F k = get(sums.k);
            const F kk = get(sums.kk);
            const F kv = get(sums.kv);
            const F v = hn::Load(d, group_.sum + i);
            const F low = hn::Load(d, rounded.low + i);
            const F high = hn::Load(d, rounded.high + i);
            const F a = local(low, i);
            const F spacing = hn::Mul(hn::Sub(local(high, i), a), constant(1.0f / static_cast<float>(Kind::kSteps)));
            // sum of (v - a - k spacing)^2, less the sum of v^2
            const F from_a = hn::Mul(a, hn::Sub(hn::Mul(constant(16.0f), a), hn::Add(v, v)));
            const F cross = hn::Sub(hn::Mul(a, k), kv);
            const F from_k = hn::Mul(spacing, hn::Add(hn::Mul(spacing, kk), hn::Add(cross, cross)));
            const F error = hn::Add(from_a, from_k);
            const F least = hn::Load(d, group_.error + i);
            const auto better = hn::Lt(error, least);
            hn::Store(hn::IfThenElse(better, error, least), d, group_.error + i);
            hn::Store(hn::IfThenElse(better, low, hn::Load(d, group_.low + i)), d, group_.low + i);
            hn::Store(hn::IfThenElse(better, high, hn::Load(d, group_.high + i)), d, group_.high + i);
            if (refined != nullptr) refine(sums, i, *refined);
        }
    }

    // Replaces endpoints by those that suit the indices best, by linear least squares.
    HWY_INLINE void refine(const Sums& sums, int i, Ends& ends) const {
        const Floats d;
        const hn::Rebind<std::uint16_t, Floats> dw;
        const hn::Rebind<std::int32_t, Floats> di;
        const auto get = [&](const std::uint16_t* row) { return hn::ConvertTo(d, hn::PromoteTo(di, hn::Load(dw, row + i))); };
        const F k = get(sums.k);
        const F kv = get(sums.kv);
        const F v = hn::Load(d, group_.sum + i);
        const F determinant = hn::Sub(hn::Mul(constant(16.0f), get(sums.kk)), hn::Mul(k, k));
        const F slope = hn::Div(hn::Sub(hn::Mul(constant(16.0f), kv), hn::Mul(k, v)), hn::Max(determinant, constant(1.0f)));
        const F start = hn::Mul(hn::Sub(v, hn::Mul(slope, k)), constant(1.0f / 16.0f));
        const F end = hn::Add(start, hn::Mul(slope, constant(static_cast<float>(Kind::kSteps))));
        const auto solvable = hn::Gt(determinant, hn::Zero(d));
        hn::Store(hn::IfThenElse(solvable, code(start, i), hn::Load(d, ends.low + i)), d, ends.low + i);
        hn::Store(hn::IfThenElse(solvable, code(end, i), hn::Load(d, ends.high + i)), d, ends.high + i);
    }

    Group& group_;
    const Kind kind_;
};

// Blocks of one value (to half a code): the endpoints that come nearest to it.
void set_single_greens(Group& group) {
    const Floats d;
    F least = constant(255.0f);
    for (int i = 0; i < lanes(); i += static_cast<int>(hn::Lanes(d))) {
        const F range = hn::Sub(hn::Load(d, group.greatest + i), hn::Load(d, group.least + i));
        least = hn::Min(least, hn::Mul(range, hn::Load(d, group.unit + i)));
    }
    if (hn::AllTrue(d, hn::Gt(least, constant(0.5f)))) return;
    for (int k = 0; k < lanes(); ++k) {
        const float unit = group.unit[k];
        if ((group.greatest[k] - group.least[k]) * unit > 0.5f) continue;
        const SingleGreen single = nearest_single_green(group.base[k] + group.sum[k] * unit * (1.0f / 16.0f));
        group.low[k] = static_cast<float>(single.lower);
        group.high[k] = static_cast<float>(single.lower + single.distance);
    }
}

// The endpoints' final choice of indices, as words of `bits` for each texel.
template <class Kind, int kBits>
HWY_INLINE void choose_indices(Group& group, Kind kind, Effort effort, W* words) {
    const Words d;
    if (effort == Effort::fast) {
        Ramp ramp;
        Fitter<Kind>(group, kind).best_ramp(ramp);
        const W factor = hn::Load(d, ramp.factor);
        const W subtract = hn::Load(d, ramp.subtract);
        pack_indices<Kind::kSteps, kBits>([&](int texel) { return index<Kind>(group, texel, factor, subtract); }, words);
    } else {
        HWY_ALIGN std::uint16_t indices[16 * kLanes];
        settle(group, kind, indices);
        pack_indices<Kind::kSteps, kBits>([&](int texel) { return hn::Load(d, indices + texel * lanes()); }, words);
    }
}

void fit_bc4_blocks(const float* const rows[4], int count, Bc4Codes codes, bool negate, Effort effort, std::byte* blocks) {
    const Words d;
    HWY_ALIGN std::uint16_t texels[16 * kLanes];
    Group group;
    for (int first = 0; first < count; first += lanes()) {
        const float* const from[4] = {rows[0] + 4 * first, rows[1] + 4 * first, rows[2] + 4 * first, rows[3] + 4 * first};
        load(from, 4 * (count - first), codes.top, negate, texels);
        make_group(texels, group);
        Fitter<Bc4Kind> fitter(group, {static_cast<float>(codes.top)});
        if (effort == Effort::fast) {
            fitter.solve(0.0f);
        } else {
            for (const float g : {0.0f, 0.5f}) {
                for (const float j : {0.0f, 1.0f, 2.0f}) fitter.start(g, j, 2);
            }
        }
        W words[3];
        choose_indices<Bc4Kind, 3>(group, {static_cast<float>(codes.top)}, effort, words);
        const W bias = hn::Set(d, static_cast<std::uint16_t>(codes.bias));
        const W byte = hn::Set(d, 0xFF);
        const W low = hn::And(hn::Sub(stored_codes(group.low), bias), byte);
        const W high = hn::And(hn::Sub(stored_codes(group.high), bias), byte);
        store_blocks(hn::Or(high, hn::ShiftLeft<8>(low)), words[0], words[1], words[2], count - first, blocks + 16 * first);
    }
}

void fit_green_blocks(const float* const rows[4], int count, bool negate, Effort effort, std::byte* blocks) {
    const Words d;
    HWY_ALIGN std::uint16_t texels[16 * kLanes];
    Group group;
    for (int first = 0; first < count; first += lanes()) {
        const float* const from[4] = {rows[0] + 4 * first, rows[1] + 4 * first, rows[2] + 4 * first, rows[3] + 4 * first};
        load(from, 4 * (count - first), 255, negate, texels);
        make_group(texels, group);
        Fitter<GreenKind> fitter(group, {});
        if (effort == Effort::fast) {
            fitter.solve(1.0f / 16.0f);
        } else {
            for (const float g : {-0.4f, 0.0f, 0.4f}) {
                for (const float j : {0.0f, 1.0f, 2.0f}) fitter.start(g, j, 3);
            }
            fitter.neighbours(2, 63.0f);
        }
        set_single_greens(group);
        W words[2];
        choose_indices<GreenKind, 2>(group, {}, effort, words);
        const W red_blue = hn::Set(d, 0xF81F);
        const W low = hn::Or(hn::ShiftLeft<5>(stored_codes(group.low)), red_blue);
        const W high = hn::Or(hn::ShiftLeft<5>(stored_codes(group.high)), red_blue);
        // Equal endpoints use index 0 only.
        const auto apart = hn::Ne(low, high);
        store_blocks(high, low, hn::IfThenElseZero(apart, words[0]), hn::IfThenElseZero(apart, words[1]), count - first, blocks + 16 * first);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace tex
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex {

HWY_EXPORT(fit_bc4_blocks);
HWY_EXPORT(fit_green_blocks);

void fit_bc4_blocks(const float* const rows[4], int count, Bc4Codes codes, bool negate, Effort effort, std::byte* blocks) {
    HWY_DYNAMIC_DISPATCH(fit_bc4_blocks)(rows, count, codes, negate, effort, blocks);
}

void fit_green_blocks(const float* const rows[4], int count, bool negate, Effort effort, std::byte* blocks) {
    HWY_DYNAMIC_DISPATCH(fit_green_blocks)(rows, count, negate, effort, blocks);
}

}  // namespace tex
#endif  // HWY_ONCE
