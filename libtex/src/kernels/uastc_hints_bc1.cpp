// SPDX-License-Identifier: Apache-2.0

#include "kernels/uastc_hints.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/uastc_hints_bc1.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/bc7_lanes-inl.h"
#include "kernels/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// What transcoders make of a block as BC1, in each of the three ways.
class Bc1Trial {
public:
    HWY_INLINE explicit Bc1Trial(const UastcHintGroup& group) : group_(group) {
        for (int c = 0; c < 3; ++c) sum_[c] = hn::Zero(d_);
        for (int k = 0; k < 16; ++k) {
            for (int c = 0; c < 3; ++c) {
                unit_[k][c] = hn::Load(d_, group.value[k][c]);
                code_[k][c] = hn::Load(d_, group.code[k][c]);
                sum_[c] = hn::Add(sum_[c], code_[k][c]);
            }
            step_[k] = hn::Load(d_, group.step[k]);
        }
    }

    // Endpoints and weights as they are.
    HWY_NOINLINE FloatVec taken() {
        FloatVec ends[2][3];
        for (int e = 0; e < 2; ++e) {
            for (int c = 0; c < 3; ++c) {
                const FloatVec code = hn::Mul(hn::Load(d_, group_.end[e][c]), Bc7Number(top(c)));
                ends[e][c] = hn::Floor(hn::Mul(hn::Add(code, Bc7Number(127.5f)), Bc7Number(1.0f / 255.0f)));
            }
        }
        return cosines(ends);
    }

    // Endpoints for these weights.
    HWY_NOINLINE FloatVec fitted_to_weights() { return fitted(); }

    // Both: weights of the line through the texels that are farthest apart on the principal axis.
    HWY_NOINLINE FloatVec fitted_to_texels() {
        FloatVec mean[3], least[3], greatest[3], axis[3], covariance[3][3];
        for (int c = 0; c < 3; ++c) {
            mean[c] = hn::Floor(hn::Mul(hn::Add(sum_[c], Bc7Number(8.0f)), Bc7Number(1.0f / 16.0f)));
            least[c] = greatest[c] = code_[0][c];
            for (int e = 0; e < 3; ++e) covariance[c][e] = hn::Zero(d_);
        }
        for (int k = 0; k < 16; ++k) {
            FloatVec off[3];
            for (int c = 0; c < 3; ++c) {
                off[c] = hn::Sub(code_[k][c], mean[c]);
                least[c] = hn::Min(least[c], code_[k][c]);
                greatest[c] = hn::Max(greatest[c], code_[k][c]);
            }
            for (int c = 0; c < 3; ++c) {
                for (int e = 0; e < 3; ++e) covariance[c][e] = MulThenAdd(off[c], off[e], covariance[c][e]);
            }
        }
        for (int c = 0; c < 3; ++c) axis[c] = hn::Sub(greatest[c], least[c]);
        for (int round = 0; round < 4; ++round) {
            FloatVec next[3];
            for (int c = 0; c < 3; ++c) next[c] = hn::Mul(Bc7Dot(covariance[c], axis), Bc7Number(1.0f / 255.0f));
            for (int c = 0; c < 3; ++c) axis[c] = next[c];
        }
        FloatVec low = Bc7Number(kBc7None), high = Bc7Number(-kBc7None), ends[2][3];
        for (int c = 0; c < 3; ++c) ends[0][c] = ends[1][c] = code_[0][c];
        for (int k = 0; k < 16; ++k) {
            const FloatVec along = Bc7Dot(code_[k], axis);
            const FloatMask is_low = hn::Lt(along, low), is_high = hn::Gt(along, high);
            low = hn::Min(along, low);
            high = hn::Max(along, high);
            for (int c = 0; c < 3; ++c) {
                ends[0][c] = hn::IfThenElse(is_low, code_[k][c], ends[0][c]);
                ends[1][c] = hn::IfThenElse(is_high, code_[k][c], ends[1][c]);
            }
        }
        round_ends(ends);
        find_steps(ends);
        return fitted();
    }

private:
    static HWY_INLINE float top(int c) { return c == 1 ? 63.0f : 31.0f; }

    static HWY_INLINE void round_ends(FloatVec ends[2][3]) {
        for (int e = 0; e < 2; ++e) {
            for (int c = 0; c < 3; ++c) {
                const FloatVec scaled = MulThenAdd(ends[e][c], Bc7Number(top(c) / 255.0f), Bc7Number(0.5f));
                ends[e][c] = Bc7Clamp(hn::Floor(scaled), top(c));
            }
        }
    }

    // The colours of four steps between endpoints of 5, 6 and 5 bits.
    HWY_INLINE void find_palette(const FloatVec ends[2][3], FloatVec palette[4][3]) const {
        for (int c = 0; c < 3; ++c) {
            const float high = c == 1 ? 4.0f : 8.0f, low = c == 1 ? 1.0f / 16.0f : 0.25f;
            for (int e = 0; e < 2; ++e)
                palette[3 * e][c] =
                    MulThenAdd(ends[e][c], Bc7Number(high), hn::Floor(hn::Mul(ends[e][c], Bc7Number(low))));
            for (int m = 1; m < 3; ++m) {
                const FloatVec both = MulThenAdd(palette[m == 1 ? 0 : 3][c], Bc7Number(2.0f),
                                                 hn::Add(palette[m == 1 ? 3 : 0][c], Bc7Number(0.5f)));
                palette[m][c] = hn::Floor(hn::Mul(both, Bc7Number(1.0f / 3.0f)));
            }
        }
    }

    HWY_INLINE void find_steps(const FloatVec ends[2][3]) {
        FloatVec palette[4][3], axis[3], along[4];
        find_palette(ends, palette);
        for (int c = 0; c < 3; ++c) axis[c] = hn::Sub(palette[3][c], palette[0][c]);
        for (int m = 0; m < 4; ++m) along[m] = Bc7Dot(palette[m], axis);
        const FloatVec one = Bc7Number(1.0f), zero = hn::Zero(d_);
        for (int k = 0; k < 16; ++k) {
            const FloatVec twice = hn::Mul(Bc7Dot(code_[k], axis), Bc7Number(2.0f));
            step_[k] = hn::IfThenElse(hn::Gt(twice, hn::Add(along[0], along[1])), one, zero);
            for (int m = 1; m < 3; ++m) {
                const FloatMask above = hn::Ge(twice, hn::Add(along[m], along[m + 1]));
                step_[k] = hn::Add(step_[k], hn::IfThenElse(above, one, zero));
            }
        }
    }

    // The sum of the cosines of all texels.
    HWY_NOINLINE FloatVec cosines(const FloatVec ends[2][3]) const {
        FloatVec palette[4][3], sum = hn::Zero(d_);
        find_palette(ends, palette);
        for (FloatVec(&entry)[3] : palette) {
            for (FloatVec& v : entry) v = hn::Sub(v, Bc7Number(kBc7Middle));
            const FloatVec inverse = hn::Div(Bc7Number(1.0f), hn::Sqrt(Bc7Dot(entry, entry)));
            for (FloatVec& v : entry) v = hn::Mul(v, inverse);
        }
        for (int k = 0; k < 16; ++k) {
            FloatVec vector[3] = {palette[0][0], palette[0][1], palette[0][2]};
            for (int m = 1; m < 4; ++m) {
                const FloatMask above = hn::Ge(step_[k], Bc7Number(static_cast<float>(m)));
                for (int c = 0; c < 3; ++c) vector[c] = hn::IfThenElse(above, palette[m][c], vector[c]);
            }
            sum = hn::Add(sum, Bc7Dot(vector, unit_[k]));
        }
        return sum;
    }

    // Least squares for the present steps, then the steps for these endpoints.
    HWY_INLINE FloatVec fitted() {
        const FloatVec zero = hn::Zero(d_), one = Bc7Number(1.0f);
        FloatVec aa = zero, ab = zero, bb = zero, bv[3] = {zero, zero, zero}, ends[2][3];
        for (int k = 0; k < 16; ++k) {
            const FloatVec b = hn::Mul(step_[k], Bc7Number(1.0f / 3.0f)), a = hn::Sub(one, b);
            aa = MulThenAdd(a, a, aa);
            ab = MulThenAdd(a, b, ab);
            bb = MulThenAdd(b, b, bb);
            for (int c = 0; c < 3; ++c) bv[c] = MulThenAdd(b, code_[k][c], bv[c]);
        }
        const FloatVec determinant = hn::Sub(hn::Mul(aa, bb), hn::Mul(ab, ab));
        const FloatMask is_line = hn::Gt(determinant, Bc7Number(1e-3f));
        const FloatVec inverse = hn::Div(one, hn::IfThenElse(is_line, determinant, one));
        for (int c = 0; c < 3; ++c) {
            const FloatVec av = hn::Sub(sum_[c], bv[c]), mean = hn::Mul(sum_[c], Bc7Number(1.0f / 16.0f));
            const FloatVec e0 = hn::Mul(hn::Sub(hn::Mul(bb, av), hn::Mul(ab, bv[c])), inverse);
            const FloatVec e1 = hn::Mul(hn::Sub(hn::Mul(aa, bv[c]), hn::Mul(ab, av)), inverse);
            ends[0][c] = hn::IfThenElse(is_line, e0, mean);
            ends[1][c] = hn::IfThenElse(is_line, e1, mean);
        }
        round_ends(ends);
        find_steps(ends);
        return cosines(ends);
    }

    const FloatTag d_ = {};
    const UastcHintGroup& group_;
    FloatVec unit_[16][3], code_[16][3], sum_[3];
    FloatVec step_[16];  // of four, from the first endpoint on
};

void FindBc1Hints(UastcHintGroup& group) {
    const FloatTag d;
    const FloatVec zero = hn::Zero(d);
    Bc1Trial trial(group);
    FloatVec best = trial.taken(), way = Bc7Number(2.0f);
    const FloatVec to_weights = trial.fitted_to_weights();
    way = hn::IfThenElse(hn::Gt(to_weights, best), Bc7Number(1.0f), way);
    best = hn::Max(best, to_weights);
    const FloatVec to_texels = trial.fitted_to_texels();
    way = hn::IfThenElse(hn::Ge(to_texels, best), zero, way);
    const FloatMask is_line = hn::Gt(hn::Load(d, group.is_one), zero);
    hn::Store(hn::IfThenElse(is_line, hn::Max(best, to_texels), to_texels), d, group.bc1_cosines);
    hn::Store(hn::IfThenElse(is_line, way, zero), d, group.bc1);
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, find_bc1_hints, FindBc1Hints, (UastcHintGroup & group), (group))

}  // namespace tex::inline v1
#endif
