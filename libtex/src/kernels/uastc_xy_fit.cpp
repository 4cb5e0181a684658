// SPDX-License-Identifier: Apache-2.0

#include "kernels/uastc_xy_fit.h"

#include <bit>

#include "blocks/uastc_modes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/uastc_xy_fit.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/bc7_guess-inl.h"
#include "kernels/dispatch.h"
#include "kernels/uastc_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

void GuessUastcXy(const Bc7Group& group, int parts, UastcXyGuesses& guesses) {
    const FloatTag d;
    // What the steps between 4 levels leave of the squared range along a line.
    constexpr float kAlong = 1.0f / 9.0f;
    FloatVec sum[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    for (int k = 0; k < 16; ++k) {
        for (int c = 0; c < 3; ++c) sum[c] = hn::Add(sum[c], hn::Load(d, group.value[k][c]));
    }
    BlockRowMoments rows;
    FindMoments(group, sum, rows);
    const BlockMoments all = rows.texels(0xffff);
    for (int k = 0; k < parts; ++k) {
        hn::Store(Bc7Number(kBc7None), d, guesses.part_error[k]);
        hn::Store(Bc7Number(-1.0f), d, guesses.part[k]);
    }
    const int mode = kUastcXyKindTable[kUastcXyParts].mode;
    for (unsigned pattern = 0; pattern < uastc_patterns(mode); ++pattern) {
        const unsigned texels = uastc_texels(mode, pattern, 1);
        const int count = std::popcount(texels);
        const BlockMoments some = rows.texels(texels);
        BlockMoments rest = all;
        rest.subtract(some);
        const BlockResidue one = ResidueOf(some, count), other = ResidueOf(rest, 16 - count);
        const FloatVec error =
            MulThenAdd(hn::Add(one.along, other.along), Bc7Number(kAlong), hn::Add(one.across, other.across));
        KeepPart(error, Bc7Number(static_cast<float>(pattern)), parts, guesses);
    }
}

// Blocks, or subsets of them, whose entries lie in a rectangle or on a line.
class UastcXyFit {
public:
    HWY_INLINE UastcXyFit(const Bc7Kind& kind, Bc7Group& group)
        : levels_(kind.levels), rows_(kind.scalar_levels == 0 ? 1 : kind.scalar_levels), group_(group) {
        for (int k = 0; k < group.texels; ++k) {
            for (int c = 0; c < 3; ++c) unit_[k][c] = hn::Load(d_, group.value[k][c]);
            weight_[k] = rows_ > 1 ? Bc7Number(1.0f) : hn::Load(d_, group.weight[k]);
        }
        for (int c = 0; c < 2; ++c) {
            for (int e = 0; e < 2; ++e) ends_[c][e] = hn::Load(d_, group.ends[e][c]);
        }
    }

    // Endpoints around the texels: along the principal axis, or of each component.
    HWY_NOINLINE void start() {
        const FloatVec zero = hn::Zero(d_), one = Bc7Number(1.0f), none = Bc7Number(4.0f);
        FloatVec count = zero, mean[2] = {zero, zero}, axes[2][2] = {{one, zero}, {zero, one}};
        for (int k = 0; k < group_.texels; ++k) {
            count = hn::Add(count, weight_[k]);
            for (int c = 0; c < 2; ++c) mean[c] = MulThenAdd(weight_[k], unit_[k][c], mean[c]);
        }
        for (FloatVec& m : mean) m = hn::Div(m, hn::Max(count, one));
        if (rows_ == 1) find_axis(mean, axes[0]);
        FloatVec low[2] = {none, none}, high[2] = {hn::Neg(none), hn::Neg(none)};
        for (int k = 0; k < group_.texels; ++k) {
            const FloatMask is_in = hn::Gt(weight_[k], zero);
            for (int a = 0; a < (rows_ == 1 ? 1 : 2); ++a) {
                const FloatVec along = MulThenAdd(hn::Sub(unit_[k][0], mean[0]), axes[a][0],
                                                  hn::Mul(hn::Sub(unit_[k][1], mean[1]), axes[a][1]));
                low[a] = hn::IfThenElse(is_in, hn::Min(low[a], along), low[a]);
                high[a] = hn::IfThenElse(is_in, hn::Max(high[a], along), high[a]);
            }
        }
        for (int c = 0; c < 2; ++c) {
            const int a = rows_ == 1 ? 0 : c;
            ends_[c][0] = code_of(MulThenAdd(low[a], axes[a][c], mean[c]));
            ends_[c][1] = code_of(MulThenAdd(high[a], axes[a][c], mean[c]));
        }
    }

    // Endpoints for the present indices, and indices for these, as long as errors fall.
    HWY_NOINLINE void refine(int solves) {
        FloatVec best[2][2], least = Bc7Number(kBc7None), numbers[16];
        for (int n = 0; n < 4; ++n) best[n / 2][n % 2] = ends_[n / 2][n % 2];
        for (int r = 0; r <= solves; ++r) {
            const FloatVec error = error_of(ends_, numbers);
            const FloatMask better = hn::Lt(error, least);
            least = hn::Min(error, least);
            for (int n = 0; n < 4; ++n)
                best[n / 2][n % 2] = hn::IfThenElse(better, ends_[n / 2][n % 2], best[n / 2][n % 2]);
            if (r < solves) solve(numbers);
        }
        for (int n = 0; n < 4; ++n) ends_[n / 2][n % 2] = best[n / 2][n % 2];
    }

    HWY_NOINLINE void improve(int rounds, bool pairs) {
        // A lane that has come to rest stays as it is, whatever the others do.
        FloatMask moves = hn::Ge(Bc7Number(1.0f), hn::Zero(d_));
        FloatVec least = rounds > 0 ? error_of(ends_, nullptr) : hn::Zero(d_);
        for (int r = 0; r < rounds; ++r) {
            const FloatVec before = least;
            const float stride = r < 2 ? static_cast<float>(4 >> r) : 1.0f;
            for (int c = 0; c < 2; ++c) {
                for (int move = 0; move < (pairs ? kBc7Moves : 4); ++move) {
                    FloatVec to[2][2] = {{ends_[0][0], ends_[0][1]}, {ends_[1][0], ends_[1][1]}};
                    for (int e = 0; e < 2; ++e)
                        to[c][e] = Bc7Clamp(hn::Add(to[c][e], Bc7Number(stride * kBc7MoveTable[move][e])), 255.0f);
                    const FloatVec error = error_of(to, nullptr);
                    const FloatMask better = hn::And(moves, hn::Lt(error, least));
                    for (int e = 0; e < 2; ++e) ends_[c][e] = hn::IfThenElse(better, to[c][e], ends_[c][e]);
                    least = hn::IfThenElse(better, error, least);
                }
            }
            if (stride == 1.0f) moves = hn::And(moves, hn::Lt(least, before));
            if (hn::AllFalse(d_, moves)) break;
        }
    }

    HWY_NOINLINE void finish(bool indices) {
        FloatVec numbers[16];
        hn::Store(error_of(ends_, indices ? numbers : nullptr), d_, group_.error);
        for (int c = 0; c < 2; ++c) {
            for (int e = 0; e < 2; ++e) hn::Store(ends_[c][e], d_, group_.ends[e][c]);
        }
        for (int k = 0; indices && k < group_.texels; ++k) {
            const FloatVec row = row_of(numbers[k]);
            hn::Store(hn::Sub(numbers[k], hn::Mul(row, Bc7Number(static_cast<float>(levels_)))), d_, group_.color[k]);
            hn::Store(row, d_, group_.scalar[k]);
        }
    }

private:
    static constexpr int kRange = 20;  // endpoints of 256 values

    static HWY_INLINE FloatVec code_of(FloatVec component) {
        return UastcRules::Round(MulThenAdd(component, Bc7Number(kBc7Middle), Bc7Number(kBc7Middle)), kRange);
    }
    [[nodiscard]] HWY_INLINE FloatVec row_of(FloatVec number) const {
        return hn::Floor(hn::Mul(hn::Add(number, Bc7Number(0.5f)), Bc7Number(1.0f / static_cast<float>(levels_))));
    }

    // The principal axis of x and y.
    HWY_INLINE void find_axis(const FloatVec mean[2], FloatVec axis[2]) const {
        const FloatVec zero = hn::Zero(d_), half = Bc7Number(0.5f);
        FloatVec xx = zero, xy = zero, yy = zero;
        for (int k = 0; k < group_.texels; ++k) {
            const FloatVec x = hn::Sub(unit_[k][0], mean[0]), y = hn::Sub(unit_[k][1], mean[1]);
            xx = MulThenAdd(weight_[k], hn::Mul(x, x), xx);
            xy = MulThenAdd(weight_[k], hn::Mul(x, y), xy);
            yy = MulThenAdd(weight_[k], hn::Mul(y, y), yy);
        }
        const FloatVec off = hn::Mul(hn::Sub(xx, yy), half), root = hn::Sqrt(MulThenAdd(off, off, hn::Mul(xy, xy)));
        const FloatMask along_x = hn::Ge(off, zero);
        const FloatVec longer = hn::Add(root, hn::Abs(off));
        axis[0] = hn::IfThenElse(along_x, longer, xy);
        axis[1] = hn::IfThenElse(along_x, xy, longer);
        const FloatVec length = hn::Sqrt(MulThenAdd(axis[0], axis[0], hn::Mul(axis[1], axis[1])));
        const FloatMask is_line = hn::Gt(length, Bc7Number(1e-12f));
        axis[0] = hn::IfThenElse(is_line, hn::Div(axis[0], length), Bc7Number(1.0f));
        axis[1] = hn::IfThenElse(is_line, hn::Div(axis[1], length), zero);
    }

    // The sum of the squared chords to the nearest entries, and the numbers of these if `numbers` is not null.
    HWY_NOINLINE FloatVec error_of(const FloatVec ends[2][2], FloatVec* numbers) const {
        const FloatVec zero = hn::Zero(d_), one = Bc7Number(1.0f), scale = Bc7Number(1.0f / kBc7Middle);
        const BlockRamp<UastcRules> ramps[2] = {{ends[0][0], ends[0][1], kRange, levels_},
                                                {ends[1][0], ends[1][1], kRange, levels_}};
        const int count = levels_ * rows_;
        FloatVec entry[16][3];
        for (int n = 0; n < count; ++n) {
            FloatVec* const v = entry[n];
            v[0] = hn::Mul(ramps[0].value(Bc7Number(UastcRules::Weight(n % levels_, levels_))), scale);
            v[1] = hn::Mul(ramps[1].value(Bc7Number(UastcRules::Weight(rows_ > 1 ? n / levels_ : n, levels_))), scale);
            const FloatVec flat = MulThenAdd(v[0], v[0], hn::Mul(v[1], v[1]));
            const FloatVec inverse = hn::Div(one, hn::Sqrt(hn::Max(flat, one)));
            v[0] = hn::Mul(v[0], inverse);
            v[1] = hn::Mul(v[1], inverse);
            v[2] = hn::Sqrt(hn::Max(hn::Sub(one, flat), zero));
        }
        FloatVec sum = zero;
        for (int k = 0; k < group_.texels; ++k) {
            FloatVec least = Bc7Number(kBc7None), best = zero;
            for (int n = 0; n < count; ++n) {
                FloatVec off[3];
                for (int c = 0; c < 3; ++c) off[c] = hn::Sub(entry[n][c], unit_[k][c]);
                const FloatVec error = Bc7Dot(off, off);
                if (numbers != nullptr)
                    best = hn::IfThenElse(hn::Lt(error, least), Bc7Number(static_cast<float>(n)), best);
                least = hn::Min(least, error);
            }
            sum = MulThenAdd(weight_[k], least, sum);
            if (numbers != nullptr) numbers[k] = best;
        }
        return sum;
    }

    // Least squares of x and of y for given entries. Steep texels count more: where z is small, angles grow.
    HWY_NOINLINE void solve(const FloatVec numbers[16]) {
        const FloatVec zero = hn::Zero(d_), one = Bc7Number(1.0f), half = Bc7Number(0.5f), small = Bc7Number(0.05f);
        FloatVec aa[2] = {zero, zero}, ab[2] = {zero, zero}, bb[2] = {zero, zero}, av[2] = {zero, zero},
                 bv[2] = {zero, zero};
        for (int k = 0; k < group_.texels; ++k) {
            const FloatVec zz = hn::Mul(unit_[k][2], unit_[k][2]);
            const FloatVec steep = hn::Div(hn::Mul(half, hn::Sub(one, zz)), hn::Max(zz, small));
            const FloatVec matters = hn::Mul(weight_[k], hn::Add(one, steep));
            const FloatVec row = row_of(numbers[k]);
            const FloatVec column = hn::Sub(numbers[k], hn::Mul(row, Bc7Number(static_cast<float>(levels_))));
            for (int c = 0; c < 2; ++c) {
                const FloatVec index = rows_ > 1 && c == 1 ? row : column;
                const FloatVec b = hn::Mul(UastcRules::Weight(index, levels_), Bc7Number(1.0f / 64.0f));
                const FloatVec a = hn::Sub(one, b), of_a = hn::Mul(matters, a), of_b = hn::Mul(matters, b);
                aa[c] = MulThenAdd(of_a, a, aa[c]);
                ab[c] = MulThenAdd(of_a, b, ab[c]);
                bb[c] = MulThenAdd(of_b, b, bb[c]);
                av[c] = MulThenAdd(of_a, unit_[k][c], av[c]);
                bv[c] = MulThenAdd(of_b, unit_[k][c], bv[c]);
            }
        }
        for (int c = 0; c < 2; ++c) {
            const FloatVec determinant = hn::Sub(hn::Mul(aa[c], bb[c]), hn::Mul(ab[c], ab[c]));
            const FloatMask is_line = hn::Gt(determinant, Bc7Number(1e-3f));
            const FloatVec inverse = hn::Div(one, hn::IfThenElse(is_line, determinant, one));
            const FloatVec e0 = hn::Mul(hn::Sub(hn::Mul(bb[c], av[c]), hn::Mul(ab[c], bv[c])), inverse);
            const FloatVec e1 = hn::Mul(hn::Sub(hn::Mul(aa[c], bv[c]), hn::Mul(ab[c], av[c])), inverse);
            ends_[c][0] = hn::IfThenElse(is_line, code_of(e0), ends_[c][0]);
            ends_[c][1] = hn::IfThenElse(is_line, code_of(e1), ends_[c][1]);
        }
    }

    const FloatTag d_ = {};
    const int levels_, rows_;
    Bc7Group& group_;
    FloatVec unit_[16][3], weight_[16];
    FloatVec ends_[2][2];  // of x and y: numbers of codes
};

void FitUastcXy(const Bc7Kind& kind, const Bc7Steps& steps, Bc7Group& group) {
    UastcXyFit fit(kind, group);
    if (steps.starts) fit.start();
    if (steps.solves > 0) fit.refine(steps.solves);
    fit.improve(steps.rounds, steps.pairs);
    fit.finish(steps.indices);
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, guess_uastc_xy, GuessUastcXy, (const Bc7Group& group, int parts, UastcXyGuesses& guesses),
           (group, parts, guesses))

TEX_KERNEL(void, fit_uastc_xy, FitUastcXy, (const Bc7Kind& kind, const Bc7Steps& steps, Bc7Group& group),
           (kind, steps, group))

}  // namespace tex::inline v1
#endif
